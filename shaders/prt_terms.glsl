// Multiplies a transfer vector with a lighting. Define the lines of prt::term_defines: PRT_NUMBERS, the
// length of a vector; PRT_COEFFICIENTS, order²; PRT_FIRST_CHANNELS and PRT_SECOND_CHANNELS, the number of
// channels, 1 or 3, of the terms of distant light that exist; PRT_LAMPS, the number of lamps;
// PRT_COLORED_LAMPS, two words with one bit per lamp that is set for three channels. Also define
// PRT_TRANSFER(at, i), number i of the vector at `at`, and PRT_LIGHT(i), color i of prt::light_columns.

#ifndef PRT_FIRST_CHANNELS
#define PRT_FIRST_CHANNELS 0
#endif
#ifndef PRT_SECOND_CHANNELS
#define PRT_SECOND_CHANNELS 0
#endif
#ifndef PRT_LAMPS
#define PRT_LAMPS 0
#endif

// Return the light of a grey or of a colored term. Its coefficients begin at `number`, its light colors at
// `color`.
vec3 prt_grey_term(uint at, uint number, uint color) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < uint(PRT_COEFFICIENTS); ++i)
        sum += PRT_TRANSFER(at, number + i) * PRT_LIGHT(color + i);
    return sum;
}
vec3 prt_colored_term(uint at, uint number, uint color) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < uint(PRT_COEFFICIENTS); ++i)
        sum += vec3(PRT_TRANSFER(at, number + i), PRT_TRANSFER(at, number + i + uint(PRT_COEFFICIENTS)),
                    PRT_TRANSFER(at, number + i + uint(2 * PRT_COEFFICIENTS))) *
               PRT_LIGHT(color + i);
    return sum;
}

#if PRT_LAMPS > 0
// Returns the light of all lamps; each has one light color and one or three coefficients.
vec3 prt_lamps(uint at, uint number, uint color) {
    const uint kColored[2] = uint[2](PRT_COLORED_LAMPS);
    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < uint(PRT_LAMPS); ++k) {
        uint more = ((kColored[k / 32u] >> (k % 32u)) & 1u) * 2u; // numbers in addition to the first
        sum += vec3(PRT_TRANSFER(at, number), PRT_TRANSFER(at, number + more / 2u), PRT_TRANSFER(at, number + more)) *
               PRT_LIGHT(color + k);
        number += 1u + more;
    }
    return sum;
}
#endif

vec3 prt_lit_vector(uint at) {
    vec3 sum = vec3(0.0);
#if PRT_FIRST_CHANNELS == 1
    sum += prt_grey_term(at, 0u, 0u);
#elif PRT_FIRST_CHANNELS == 3
    sum += prt_colored_term(at, 0u, 0u);
#endif
#if PRT_SECOND_CHANNELS == 1
    sum += prt_grey_term(at, uint(PRT_FIRST_CHANNELS * PRT_COEFFICIENTS), uint(PRT_COEFFICIENTS));
#elif PRT_SECOND_CHANNELS == 3
    sum += prt_colored_term(at, uint(PRT_FIRST_CHANNELS * PRT_COEFFICIENTS), uint(PRT_COEFFICIENTS));
#endif
#if PRT_LAMPS > 0
    const uint kParts = uint(PRT_FIRST_CHANNELS > 0) + uint(PRT_SECOND_CHANNELS > 0);
    sum += prt_lamps(at, uint((PRT_FIRST_CHANNELS + PRT_SECOND_CHANNELS) * PRT_COEFFICIENTS),
                     kParts * uint(PRT_COEFFICIENTS));
#endif
    return sum;
}

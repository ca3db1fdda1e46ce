// The light of a transfer vector of one part or two. Define PRT_COEFFICIENTS (order²), PRT_FIRST_CHANNELS and, where
// there is a second part, PRT_SECOND_CHANNELS: 1 or 3; and PRT_TRANSFER(at, i), number i of the vector at `at`, and
// PRT_LIGHT(i), color i of prt::light_columns.

#ifndef PRT_SECOND_CHANNELS
#define PRT_SECOND_CHANNELS 0
#endif
#define PRT_CHANNELS_OF_PARTS (PRT_FIRST_CHANNELS + PRT_SECOND_CHANNELS)

// What the colors from `color` on give of a grey part, whose numbers begin at `number`, and of a colored one.
vec3 prt_grey_part(uint at, uint number, uint color) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < uint(PRT_COEFFICIENTS); ++i)
        sum += PRT_TRANSFER(at, number + i) * PRT_LIGHT(color + i);
    return sum;
}
vec3 prt_colored_part(uint at, uint number, uint color) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < uint(PRT_COEFFICIENTS); ++i)
        sum += vec3(PRT_TRANSFER(at, number + i), PRT_TRANSFER(at, number + i + uint(PRT_COEFFICIENTS)),
                    PRT_TRANSFER(at, number + i + uint(2 * PRT_COEFFICIENTS))) *
               PRT_LIGHT(color + i);
    return sum;
}

vec3 prt_lit_vector(uint at) {
#if PRT_FIRST_CHANNELS == 1
    vec3 sum = prt_grey_part(at, 0u, 0u);
#else
    vec3 sum = prt_colored_part(at, 0u, 0u);
#endif
#if PRT_SECOND_CHANNELS == 1
    sum += prt_grey_part(at, uint(PRT_FIRST_CHANNELS * PRT_COEFFICIENTS), uint(PRT_COEFFICIENTS));
#elif PRT_SECOND_CHANNELS == 3
    sum += prt_colored_part(at, uint(PRT_FIRST_CHANNELS * PRT_COEFFICIENTS), uint(PRT_COEFFICIENTS));
#endif
    return sum;
}

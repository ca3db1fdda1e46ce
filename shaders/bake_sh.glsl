// The spherical-harmonic basis by recurrence (docs/math.md, eq. 3). Define PRT_ORDER before including.

#define PRT_COEFFICIENTS (PRT_ORDER * PRT_ORDER)

layout(std140, binding = PRT_BINDING_SH_FACTORS) uniform ShFactors {
    vec4 sh_factors[PRT_MOST_COEFFICIENTS]; // at PRT_SH_FACTOR(l, m): a_lm, b_lm, and where l = m the sectoral factor
};

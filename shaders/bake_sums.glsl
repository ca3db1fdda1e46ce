// Sums of vectors over receivers or samples, to which any thread can add at any time: in fixed point, so that
// they do not depend on the order.

layout(constant_id = PRT_CONSTANT_SUMMED) const bool kSummed = false; // vectors are added to sums and not stored

layout(std430, binding = PRT_BINDING_SUM_ROWS) readonly buffer SumRows {
    SumRow sum_rows[];
};
layout(std430, binding = PRT_BINDING_FIXED_SUMS) buffer FixedSums {
    int fixed_sums[]; // [sums][columns]
};

int fixed_point(float value) {
    return int(roundEven(clamp(value, -PRT_FIXED_LIMIT, PRT_FIXED_LIMIT) * PRT_FIXED_ONE));
}

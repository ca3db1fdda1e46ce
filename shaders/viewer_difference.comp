// Sums over the surfaces visible in two pictures: squared difference, squared second picture, number of
// pixels, and mean of the second picture's channels. Writes one row of sums per group; the reader adds them.

#include "shared_viewer.h"

layout(local_size_x = 16, local_size_y = 16) in;

layout(binding = PRT_UNIT_LEFT) uniform sampler2D left_picture;
layout(binding = PRT_UNIT_RIGHT) uniform sampler2D right_picture;
uniform ivec2 size;
layout(std430, binding = PRT_BINDING_DIFFERENCE) writeonly buffer Sums {
    vec4 sums[];
};

shared vec4 partial[256];

vec4 averaged(sampler2D picture, ivec2 pixel) {
    ivec2 samples = max(textureSize(picture, 0) / size, ivec2(1));
    vec4 sum = vec4(0.0);
    for (int y = 0; y < samples.y; ++y)
        for (int x = 0; x < samples.x; ++x)
            sum += texelFetch(picture, pixel * textureSize(picture, 0) / size + ivec2(x, y), 0);
    return sum / float(samples.x * samples.y);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    vec4 mine = vec4(0.0);
    if (all(lessThan(pixel, size))) {
        vec4 a = averaged(left_picture, pixel), b = averaged(right_picture, pixel);
        vec3 d = a.rgb - b.rgb;
        if (a.a > 0.5 && b.a > 0.5)
            mine = vec4(dot(d, d), dot(b.rgb, b.rgb), 1.0, (b.r + b.g + b.b) / 3.0);
    }
    partial[gl_LocalInvocationIndex] = mine;
    barrier();
    for (uint half_count = 128u; half_count > 0u; half_count >>= 1) {
        if (gl_LocalInvocationIndex < half_count)
            partial[gl_LocalInvocationIndex] += partial[gl_LocalInvocationIndex + half_count];
        barrier();
    }
    if (gl_LocalInvocationIndex == 0u)
        sums[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = partial[0];
}

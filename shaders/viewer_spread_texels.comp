// Computes a map for surfaces from the exit radiance of a baked lightmap's receivers: texels without a
// receiver take the value of a near one. One texel per thread; dispatch (width + 7) / 8 by (height + 7) / 8
// groups, then generate mipmaps.

#include "shared_layout.h"
#include "shared_viewer.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = PRT_BINDING_RAW_RADIANCE) readonly buffer Radiance {
    float radiance[]; // [receivers][3]
};
layout(std430, binding = PRT_BINDING_TEXEL_RECEIVERS) readonly buffer Nearest {
    uint receivers[]; // [texels of the map]
};
layout(binding = PRT_IMAGE_TEXELS, rgba16f) writeonly uniform image2D lightmap;

const float kMaxHalf = 65504.0;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(lightmap);
    if (any(greaterThanEqual(texel, size)))
        return;
    uint at = 3u * receivers[texel.y * size.x + texel.x];
    vec3 lit = vec3(radiance[at], radiance[at + 1u], radiance[at + 2u]);
    imageStore(lightmap, texel, vec4(clamp(lit, vec3(-kMaxHalf), vec3(kMaxHalf)), 1.0));
}

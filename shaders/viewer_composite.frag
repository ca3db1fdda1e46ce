// Draws two pictures on the screen: split into left and right, or their difference as a heat map.

#include "shared_viewer.h"

layout(binding = PRT_UNIT_LEFT) uniform sampler2D left_picture;
layout(binding = PRT_UNIT_RIGHT) uniform sampler2D right_picture;
uniform ivec2 size;        // size of the screen, pixels
uniform float split;       // pixels from the left
uniform bvec2 tone_mapped; // left, right: apply exposure and tone curve; otherwise show unchanged
uniform float exposure;
uniform bool difference;
uniform float white; // radiance that is white in the heat map

out vec4 result;

// Tone curve: the rational fit of Narkowicz (2016) to the ACES curve, equal to prt::tone_mapped.
vec3 display(vec3 color, bool mapped) {
    if (mapped) {
        vec3 x = min(color * exposure, vec3(1e4));
        color = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    }
    return clamp(color, 0.0, 1.0);
}

vec3 encode(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(max(c, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), c));
}

// A picture may have several samples per pixel: maps each sample, then averages them.
vec3 shown(sampler2D picture, bool mapped) {
    ivec2 samples = max(textureSize(picture, 0) / size, ivec2(1));
    ivec2 first = ivec2(gl_FragCoord.xy) * textureSize(picture, 0) / size; // a coarse picture has larger pixels
    vec3 sum = vec3(0.0);
    for (int y = 0; y < samples.y; ++y)
        for (int x = 0; x < samples.x; ++x)
            sum += display(texelFetch(picture, first + ivec2(x, y), 0).rgb, mapped);
    return sum / float(samples.x * samples.y);
}

vec4 averaged(sampler2D picture) {
    ivec2 samples = max(textureSize(picture, 0) / size, ivec2(1));
    ivec2 first = ivec2(gl_FragCoord.xy) * textureSize(picture, 0) / size; // a coarse picture has larger pixels
    vec4 sum = vec4(0.0);
    for (int y = 0; y < samples.y; ++y)
        for (int x = 0; x < samples.x; ++x)
            sum += texelFetch(picture, first + ivec2(x, y), 0);
    return sum / float(samples.x * samples.y);
}

vec3 heat(float share) {
    float ramp = 3.0 * min(share, 1.0);
    return clamp(vec3(ramp, ramp - 1.0, ramp - 2.0), 0.0, 1.0);
}

void main() {
    vec3 color;
    if (difference) {
        vec4 a = averaged(left_picture), b = averaged(right_picture);
        vec3 d = abs(a.rgb - b.rgb);
        bool surface = a.a > 0.5 && b.a > 0.5;
        color = surface ? heat(max(d.r, max(d.g, d.b)) / white) : vec3(0.015, 0.02, 0.03);
    } else if (gl_FragCoord.x < split) {
        color = shown(left_picture, tone_mapped.x);
    } else {
        color = shown(right_picture, tone_mapped.y);
    }
    result = vec4(encode(color), 1.0);
}

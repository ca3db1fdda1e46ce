// Draws a lat-long image in the view direction. Filters in the shader, because bilinear weights of the
// hardware have few bits.

#include "shared_layout.h"

in vec2 position;

layout(binding = PRT_UNIT_BACKGROUND) uniform sampler2D background;
uniform vec3 forward, right, up; // right and up are scaled to the edge of the picture
uniform float rotation;          // about +Y, radians

out vec4 result;

const float kPi = 3.14159265358979;

vec3 texel(int x, int y, ivec2 size) {
    return texelFetch(background, ivec2((x % size.x + size.x) % size.x, clamp(y, 0, size.y - 1)), 0).rgb;
}

void main() {
    vec3 d = normalize(forward + position.x * right + position.y * up);
    d.xz = vec2(cos(rotation) * d.x - sin(rotation) * d.z, sin(rotation) * d.x + cos(rotation) * d.z);
    ivec2 size = textureSize(background, 0);
    vec2 at = vec2(0.5 - atan(d.x, d.z) / (2.0 * kPi), acos(clamp(d.y, -1.0, 1.0)) / kPi) * vec2(size) - 0.5;
    ivec2 low = ivec2(floor(at));
    vec2 f = at - vec2(low);
    result = vec4(mix(mix(texel(low.x, low.y, size), texel(low.x + 1, low.y, size), f.x),
                      mix(texel(low.x, low.y + 1, size), texel(low.x + 1, low.y + 1, size), f.x), f.y),
                  1.0);
}

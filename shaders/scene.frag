// Exit radiance times base color, linear.

#include "surface.glsl"

in vec3 radiance;

out vec4 result;

void main() {
    vec4 base = surface_base_color();
    result = vec4(max(radiance, vec3(0.0)) * base.rgb, base.a);
}

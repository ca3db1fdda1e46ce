// Draws a lat-long image rotated about +Y by `angle`; `middle` is the column that faces +Z: 0.75 if the
// centre faces +X, as in three, and 0.5 if it faces +Z, as in OpenEXR.
uniform sampler2D environment;
uniform float angle;
uniform float middle;
uniform float strength;
varying vec3 direction;

void main() {
  vec3 d = normalize(direction);
  d.xz = vec2(cos(angle) * d.x - sin(angle) * d.z, sin(angle) * d.x + cos(angle) * d.z);
  vec2 uv = vec2(middle - atan(d.x, d.z) / 6.28318530718, 1.0 - acos(clamp(d.y, -1.0, 1.0)) / 3.14159265359);
  gl_FragColor = vec4(strength * textureLod(environment, uv, 0.0).rgb, 1.0);
#include <tonemapping_fragment>
#include <colorspace_fragment>
}

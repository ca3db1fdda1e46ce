// Draws each probe lit by its own light; blind probes are red.

#include "prt_volume.glsl"

flat in vec3 middle;
flat in int sealed;
in vec3 normal;
uniform float exposure; // exposure of the picture: red then has the same brightness under any light
out vec4 result;

void main() {
    vec3 lit = vec3(0.7, 0.02, 0.02) / exposure;
    if (sealed == 0) {
        vec3 light[PRT_VOLUME_COEFFICIENTS];
        prt_volume_incident(middle, vec3(0.0), light); // at its corner no other probe contributes
        lit = 0.8 * prt_incident_irradiance(light, normalize(normal));
    }
    result = vec4(min(lit, vec3(65000.0)), 1.0);
}

// Draws the probes of a volume as spheres, one instance each, without vertex data.

#include "shared_viewer.h"

layout(std430, binding = PRT_BINDING_PROBE_POSITIONS) readonly buffer ProbePositions {
    vec4 probe_positions[]; // w: radius, negative if the probe is blind
};

uniform mat4 view_projection;

flat out vec3 middle;
flat out int sealed;
out vec3 normal;

void main() {
    // Two triangles for each cell of latitude and longitude.
    const ivec2 kCorners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 1), ivec2(1, 0), ivec2(0, 0), ivec2(0, 1), ivec2(1, 1));
    int cell = gl_VertexID / 6;
    ivec2 at = ivec2(cell % PRT_PROBE_COLUMNS, cell / PRT_PROBE_COLUMNS) + kCorners[gl_VertexID % 6];
    float longitude = 6.2831853 * float(at.x) / float(PRT_PROBE_COLUMNS);
    float latitude = 3.14159265 * float(at.y) / float(PRT_PROBE_ROWS);
    normal = vec3(sin(latitude) * sin(longitude), cos(latitude), sin(latitude) * cos(longitude));
    vec4 probe = probe_positions[gl_InstanceID];
    middle = probe.xyz;
    sealed = probe.w < 0.0 ? 1 : 0;
    gl_Position = view_projection * vec4(middle + abs(probe.w) * normal, 1.0);
}

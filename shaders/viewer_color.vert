// Colored triangles and lines: lobes, wires.

#include "shared_layout.h"

layout(location = PRT_LOCATION_POSITION) in vec3 position;
layout(location = PRT_LOCATION_COLOR) in vec4 color;
uniform mat4 view_projection;
out vec4 surface_color;

void main() {
    surface_color = color;
    gl_Position = view_projection * vec4(position, 1.0);
}

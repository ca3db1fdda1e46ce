// Surfaces and their positions in a lightmap, for viewer_texel_grid.frag.

#include "shared_layout.h"

layout(location = PRT_LOCATION_POSITION) in vec3 position;
layout(location = PRT_LOCATION_TEXCOORD) in vec2 texcoord;
layout(location = PRT_LOCATION_COLOR) in vec4 color;

#include "lightmap_vertex.glsl"

uniform mat4 view_projection;

out vec2 surface_texcoord;
out vec4 surface_color;

void main() {
    take_for_lightmap();
    surface_texcoord = texcoord;
    surface_color = color;
    gl_Position = view_projection * vec4(position, 1.0);
}

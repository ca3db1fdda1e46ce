// Vertex data for a fragment shader with lightmap.glsl.

#include "shared_layout.h"

layout(location = PRT_LOCATION_LIGHTMAP) in vec2 lightmap_placement;

out vec2 lightmap_texcoord;

void take_for_lightmap() {
    lightmap_texcoord = lightmap_placement;
}

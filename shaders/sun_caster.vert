// Surfaces that block a sun, in the projection of its map.

#include "shared_layout.h"
#include "sun_view.glsl"
#ifdef PRT_SKINNED
#include "skinning.glsl"
#endif

layout(location = PRT_LOCATION_POSITION) in vec3 position;
layout(location = PRT_LOCATION_TEXCOORD) in vec2 texcoord;
layout(location = PRT_LOCATION_COLOR) in vec4 color;
layout(location = PRT_LOCATION_GLASS_TEXCOORD) in vec2 glass_texcoord;

uniform int map;
uniform float map_size; // texels

out vec2 surface_texcoord;
out vec4 surface_color;
out vec2 surface_glass_texcoord;
out float depth; // metres behind the near plane

void main() {
    surface_texcoord = texcoord;
    surface_color = color;
    surface_glass_texcoord = glass_texcoord;
#ifdef PRT_SKINNED
    vec3 caster = (vertex_matrix() * vec4(position, 1.0)).xyz;
#else
    vec3 caster = position;
#endif
    vec3 point = position_in_map(suns_seen.maps[map], caster - suns_seen.eye.xyz);
    depth = point.z;
    gl_Position = vec4(2.0 * vec3(point.xy / map_size, point.z / suns_seen.maps[map].depth) - 1.0, 1.0);
}

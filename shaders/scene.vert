// Vertices of the scene. Define PRT_COMPRESSED to compute exit radiance here from compressed transfer,
// PRT_LIGHTMAP if the fragment shader looks it up, PRT_SUNS for a fragment shader that adds suns.

#include "shared_layout.h"

#include "emission_vertex.glsl"
#ifdef PRT_SUNS
#include "sun_vertex.glsl"
#endif
#if defined(PRT_LIGHTMAP)
#include "lightmap_vertex.glsl"
#elif defined(PRT_COMPRESSED)
#include "prt_exit_radiance.glsl"
#else
layout(location = PRT_LOCATION_RADIANCE) in vec3 vertex_radiance;
#endif

layout(location = PRT_LOCATION_POSITION) in vec3 position;
layout(location = PRT_LOCATION_TEXCOORD) in vec2 texcoord;
layout(location = PRT_LOCATION_COLOR) in vec4 color;
#ifdef PRT_PREDICTOR_NORMAL
layout(location = PRT_LOCATION_NORMAL) in vec3 normal;
#else
const vec3 normal = vec3(0.0);
#endif

uniform mat4 view_projection;

#ifndef PRT_LIGHTMAP
out vec3 radiance;
#endif
out vec2 surface_texcoord;
out vec4 surface_color;

void main() {
#if defined(PRT_LIGHTMAP)
    take_for_lightmap();
#elif defined(PRT_COMPRESSED)
    radiance = prt_exit_radiance(position, normal);
#else
    radiance = vertex_radiance;
#endif
#ifdef PRT_SUNS
    take_for_suns(position);
#endif
    take_for_emission();
    surface_texcoord = texcoord;
    surface_color = color;
    gl_Position = view_projection * vec4(position, 1.0);
}

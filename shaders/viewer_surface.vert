// Vertices of the viewer's models. Exit radiance comes from PRT_COMPRESSED transfer, is PRT_VERTEX_RADIANCE
// (an attribute, or for instances a buffer), or comes from a PRT_LIGHTMAP. With none of these, the fragment
// shader computes it from the normal and an ambient occlusion. PRT_SUNS: for separate suns. PRT_OCCLUDED:
// near moving objects. PRT_INSTANCED: for instances. Emission is added in all cases.

#include "shared_layout.h"
#include "instance_position.glsl"
#include "vertex_normals.glsl"

layout(location = PRT_LOCATION_POSITION) in vec3 position;
layout(location = PRT_LOCATION_TEXCOORD) in vec2 texcoord;
layout(location = PRT_LOCATION_COLOR) in vec4 color;

#include "emission_vertex.glsl"
#ifdef PRT_SUNS
#include "sun_vertex.glsl"
#endif
#ifdef PRT_OCCLUDED
out vec3 occluded_position, occluded_normal;
#endif
#if defined(PRT_LIGHTMAP)
#include "lightmap_vertex.glsl"
#elif defined(PRT_COMPRESSED)
#include "prt_exit_radiance.glsl"
#ifdef PRT_PREDICTOR_NORMAL
layout(location = PRT_LOCATION_NORMAL) in vec3 vertex_normal;
#else
const vec3 vertex_normal = vec3(0.0);
#endif
out vec3 radiance;
#elif defined(PRT_VERTEX_RADIANCE)
#ifdef PRT_INSTANCED
#include "instance_radiance.glsl"
#else
layout(location = PRT_LOCATION_RADIANCE) in vec3 vertex_radiance;

vec3 radiance_of_vertex() {
    return vertex_radiance;
}
#endif
out vec3 radiance;
#else
layout(location = PRT_LOCATION_NORMAL) in vec3 vertex_normal;
layout(location = PRT_LOCATION_AO) in float vertex_ao;
out vec3 normal;
out float ao;
#endif

uniform mat4 view_projection;

out vec2 surface_texcoord;
out vec4 surface_color;

void main() {
    vec3 point = position_in_scene(position);
#if defined(PRT_LIGHTMAP)
    take_for_lightmap();
#elif defined(PRT_COMPRESSED)
    radiance = prt_exit_radiance(position, vertex_normal);
#elif defined(PRT_VERTEX_RADIANCE)
    radiance = radiance_of_vertex();
#else
    normal = normal_in_scene(vertex_normal);
    ao = vertex_ao;
#endif
#ifdef PRT_SUNS
    take_for_suns(point);
    sun_normal = normal_in_scene(sun_normal);
#endif
#ifdef PRT_OCCLUDED
    occluded_position = point;
    occluded_normal = normal_in_scene(normal_of_vertex());
#endif
    take_for_emission();
    surface_texcoord = texcoord;
    surface_color = color;
    gl_Position = view_projection * vec4(point, 1.0);
}

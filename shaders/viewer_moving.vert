// Moving objects in the viewer's scene. PRT_SUNS: for separate suns. PRT_LOBED: vertices have lobes.

#include "shared_layout.h"

layout(location = PRT_LOCATION_POSITION) in vec3 position;
layout(location = PRT_LOCATION_TEXCOORD) in vec2 texcoord;
layout(location = PRT_LOCATION_COLOR) in vec4 color;
layout(location = PRT_LOCATION_NORMAL) in vec3 vertex_normal;

#include "emission_vertex.glsl"
#include "skinning.glsl"
#ifdef PRT_SUNS
#include "sun_vertex.glsl"
#endif

#ifdef PRT_LOBED
#include "viewer_lobes.glsl"
out vec3 lobed_radiance;
#endif

uniform mat4 view_projection;

out vec2 surface_texcoord;
out vec4 surface_color;
out vec3 point, normal;

void main() {
    mat4 matrix = vertex_matrix();
    point = (matrix * vec4(position, 1.0)).xyz;
    normal = moved_normal(matrix, vertex_normal);
#ifdef PRT_LOBED
    lobed_radiance = radiance_of_lobes(mat3(matrix), point, normal);
#endif
#ifdef PRT_SUNS
    take_for_suns(point);
    sun_normal = normal; // the normal after the motion
#endif
    take_for_emission();
    surface_texcoord = texcoord;
    surface_color = color;
    gl_Position = view_projection * vec4(point, 1.0);
}

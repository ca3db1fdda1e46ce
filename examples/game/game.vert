// Vertex shader of a relit surface. It follows the text of prtkit's prt_exit_radiance.glsl, which contains
// #version.

layout(location = PRT_LOCATION_POSITION) in vec3 position;
layout(location = PRT_LOCATION_NORMAL) in vec3 vertex_normal;
uniform mat4 view_projection, sun_map; // from the world, the second to [0, 1]³
out vec3 radiance, normal, sun_position;

void main() {
    radiance = prt_exit_radiance(position, vertex_normal); // for albedo 1, without the sun's direct light
    normal = vertex_normal;
    sun_position = (sun_map * vec4(position, 1.0)).xyz;
    gl_Position = view_projection * vec4(position, 1.0);
}

#version 330 core
// Projects blockers into the shadow map of the sun.
layout(location = 0) in vec3 position;
uniform mat4 sun_map;

void main() {
    gl_Position = vec4(2.0 * (sun_map * vec4(position, 1.0)).xyz - 1.0, 1.0);
}

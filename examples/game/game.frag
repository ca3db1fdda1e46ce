#version 330 core
// The pixel of a relit surface: radiance times albedo, exposed.
in vec3 radiance; // of the vertex shader that prtkit writes, for albedo 1
out vec4 pixel;
uniform vec3 albedo;
uniform float exposure;

void main() {
    vec3 exposed = 1.0 - exp(-exposure * albedo * max(radiance, 0.0));
    pixel = vec4(pow(exposed, vec3(1.0 / 2.2)), 1.0);
}

#version 330 core
// Shades a relit surface: light by transfer plus the shadowed sun, times albedo and exposure.
in vec3 radiance, normal, sun_position;
out vec4 pixel;
uniform vec3 albedo;
uniform float exposure;
uniform vec3 towards_sun, sun_irradiance;
uniform sampler2DShadow shadow_map;
uniform float sun_radius; // penumbra radius per distance from the blocker

// Returns the visible fraction of the sun: 16 taps over the penumbra of a blocker halfway to the near side of
// the map. `bias` and positions are in units of the map.
float sun_visibility(float bias) {
    float radius = max(0.5 * sun_radius * sun_position.z, 1.0 / float(textureSize(shadow_map, 0).x)),
          open = 0.0;
    for (int i = 0; i < 16; ++i) {
        float angle = 2.4 * float(i);
        vec2 tap = radius * sqrt((float(i) + 0.5) / 16.0) * vec2(cos(angle), sin(angle));
        open += texture(shadow_map, sun_position + vec3(tap, -bias)) / 16.0;
    }
    return open;
}

void main() {
    float cosine = max(dot(normalize(normal), towards_sun), 0.0);
    float texel = 1.0 / float(textureSize(shadow_map, 0).x);
    vec3 sun = sun_irradiance / 3.14159265 * cosine * sun_visibility(2.0 * texel / max(cosine, 0.1));
    vec3 exposed = 1.0 - exp(-exposure * albedo * (max(radiance, 0.0) + sun));
    pixel = vec4(pow(exposed, vec3(1.0 / 2.2)), 1.0);
}

// Moving objects, lit by a volume (PRT_VOLUME), or without one by unoccluded light; PRT_LOBED: by the lobes
// of the vertices under that light. Blended surfaces are drawn opaque.

#include "surface.glsl"
#include "emission.glsl"
#ifdef PRT_SUNS
#include "sun_light.glsl"
#endif
#ifdef PRT_VOLUME
#include "prt_volume.glsl"
#else
#include "irradiance.glsl"
#endif

in vec3 point, normal;
uniform vec3 eye;
uniform bool chrome;
out vec4 result;

#ifdef PRT_LOBED
in vec3 lobed_radiance;
#endif

#ifdef PRT_VOLUME
vec3 mirrored_radiance(vec3 n, vec3 towards) {
    vec3 light[PRT_VOLUME_COEFFICIENTS];
    prt_volume_incident(point, n, light);
    const vec4 kHann = vec4(1.0, 0.75, 0.25, 0.0); // without it bright areas are surrounded by black rings
    return prt_incident_sum(light, towards, kHann);
}
vec3 matt_radiance(vec3 n) {
    return prt_volume_irradiance(point, n);
}
#else
vec3 mirrored_radiance(vec3 n, vec3 towards) {
    return unshadowed_radiance(towards);
}
vec3 matt_radiance(vec3 n) {
    return unshadowed_radiance(n);
}
#endif

vec3 diffuse_radiance(vec3 n) {
#ifdef PRT_LOBED
    return lobed_radiance;
#else
    return matt_radiance(n);
#endif
}

// Mirrors a sun as a lobe with the same energy (Phong), with the width of a highlight on a screen.
vec3 mirrored_suns(vec3 n, vec3 towards) {
    vec3 sum = vec3(0.0);
#ifdef PRT_SUNS
    const float kExponent = 400.0;
    for (int i = 0; i < suns_seen.count; ++i) {
        vec3 sun = suns_seen.suns[i].towards.xyz;
        float lobe = 0.5 * (kExponent + 1.0) * pow(max(dot(towards, sun), 0.0), kExponent); // multiplied by
                                                                                            // irradiance over
                                                                                            // pi
        if (dot(n, sun) > 0.0 && lobe > 1e-4)
            sum += suns_seen.suns[i].open.rgb * lobe * sun_visibility(i, seen, n);
    }
#endif
    return sum;
}

void main() {
    vec3 base = surface_base_color().rgb;
    vec3 n = normalize(gl_FrontFacing ? normal : -normal);
    vec3 towards = reflect(normalize(point - eye), n);
    vec3 lit = chrome ? base * (mirrored_radiance(n, towards) + mirrored_suns(n, towards)) : base * diffuse_radiance(n);
#ifdef PRT_SUNS
    if (!chrome)
        lit += sun_radiance(base);
#endif
    result = vec4(min(lit + emitted_radiance(), vec3(65000.0)), 1.0);
}

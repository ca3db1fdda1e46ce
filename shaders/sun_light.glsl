// Light of suns that a surface scatters to the camera: Lambertian on the visible side, and diffuse through
// thin sheets (docs/math.md, eq. 38).

#include "surface.glsl"
#include "sun_shadows.glsl"

in vec3 seen, sun_normal;
in vec2 factor_texcoord, tint_texcoord;

layout(binding = PRT_UNIT_TRANSMISSION_FACTOR) uniform sampler2D factor_texture;
layout(binding = PRT_UNIT_TRANSMISSION_TINT) uniform sampler2D tint_texture;
uniform bool has_transmission_factor, has_transmission_tint;
uniform mat3x2 factor_transform, tint_transform;
uniform bool sunlit;               // all light of a medium is indirect
uniform float transmission_factor; // 0 if the surface is not a thin sheet
uniform vec3 transmission_tint;

// Share of light from the other side that is transmitted, and its color.
vec3 transmitted_share(out float through) {
    through = transmission_factor;
    if (has_transmission_factor)
        through *= filtered_texture(factor_texture, factor_transform * vec3(factor_texcoord, 1.0)).a;
    through = clamp(through, 0.0, 1.0);
    vec3 tint = transmission_tint;
    if (has_transmission_tint)
        tint *= filtered_texture(tint_texture, tint_transform * vec3(tint_texcoord, 1.0)).rgb;
    return through * tint;
}

// `base`: result of surface_base_color.
vec3 sun_radiance(vec3 base) {
    vec3 face = normalize(cross(dFdx(seen), dFdy(seen)));
    face = dot(face, seen) > 0.0 ? -face : face; // towards the camera
    float through;
    vec3 transmitted = transmitted_share(through), reflected = base * (1.0 - through);
    if (!textured) // for albedo 1
        transmitted /= max(material_color().rgb, vec3(1.0 / 255.0));
    vec3 normal = length(sun_normal) > 0.0 ? normalize(gl_FrontFacing ? sun_normal : -sun_normal) : face;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < suns_seen.count; ++i) {
        vec3 towards = suns_seen.suns[i].towards.xyz;
        float cosine = dot(normal, towards);
        vec3 share = cosine > 0.0 ? reflected : transmitted;
        // The triangle shadows itself on a side that faces away from the sun.
        if (cosine * dot(face, towards) > 0.0 && share != vec3(0.0))
            sum += suns_seen.suns[i].open.rgb * abs(cosine) * share * sun_visibility(i, seen, face);
    }
    return sunlit ? sum : vec3(0.0);
}

// Computes coverage, reflectance and transmittance of points on surfaces from materials and textures
// (docs/math.md, section 6).

#include "bake/scene/surfaces.h"

#include "bake/scene/interpolated.h"
#include "prt/core/light.h"
#include "prt/render/tone_map.h"
#include "runtime/load/light_passing.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Twice the area of a triangle in the plane.
float doubled_area(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
    return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

/// Share of the diffuse reflectance that remains at a point that transmits `glass` of the rays, without tint:
/// the light that arrives belongs to the rays that were not transmitted.
float left_of_glass(const Material& material, float texel) {
    const float blocked = 1 - glass_transmittance(material) * texel;
    return blocked > 0 ? (1 - material.glass.factor * texel) / blocked : 0.0f;
}

} // namespace

Surfaces::Surfaces(const Scene& scene, const std::vector<Texture>& textures, const std::vector<bool>& solid)
    : scene_(scene), textures_(textures) {
    triangles_.reserve(scene.triangles());
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const Primitive& primitive = scene.primitives[p];
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        const Material& material = scene.materials[primitive.material];
        for (const glm::uvec3& t : primitive.triangles)
            triangles_.push_back({t + static_cast<unsigned>(vertices.first_receiver), p});
        const Kind kind = kind_of(primitive, !solid.empty() && solid[primitive.material]);
        kinds_.push_back(kind);
        traits_.alpha |= !kind.opaque;
        traits_.textured |= !kind.constant || !kind.opaque;
        traits_.transmission |= kind.thin;
        const glm::vec3 base(material.base_color);
        traits_.scattering |= (kind.constant ? kind.constant->reflected : base) != glm::vec3(0) || kind.thin;
        traits_.color |= !prt::is_grey(base) || !is_grey(material.base_color_texture) ||
                         std::any_of(vertices.colors.begin(), vertices.colors.end(),
                                     [](const glm::vec4& c) { return !prt::is_grey(glm::vec3(c)); });
        if (kind.thin)
            traits_.color |=
                !prt::is_grey(material.transmission.color) || !is_grey(material.transmission.color_texture);
    }
}

bool Surfaces::has_texture(const VertexArray& vertices, const TextureUse& use) const {
    return use.image >= 0 && !textures_.empty() && !is_missing(use, textures_) &&
           static_cast<std::size_t>(use.texcoord) < vertices.texcoords.size() &&
           !vertices.texcoords[static_cast<std::size_t>(use.texcoord)].empty();
}

bool Surfaces::is_grey(const TextureUse& use) const {
    if (use.image < 0 || textures_.empty() || is_missing(use, textures_))
        return true;
    const auto& pixels = textures_[static_cast<std::size_t>(use.image)].levels[0].pixels;
    return std::all_of(pixels.begin(), pixels.end(),
                       [](const glm::u8vec4& p) { return p.r == p.g && p.g == p.b; });
}

Surfaces::Kind Surfaces::kind_of(const Primitive& primitive, bool solid) const {
    const Material& material = scene_.materials[primitive.material];
    const VertexArray& vertices = scene_.vertex_arrays[primitive.vertices];
    Kind kind;
    kind.solid = solid;
    const bool textured = has_texture(vertices, material.base_color_texture);
    // A surface whose coverage is never below 1 counts as opaque.
    kind.opaque = material.glass.factor <= 0 &&
                  (material.alpha_mode == AlphaMode::opaque ||
                   (!textured && vertices.colors.empty() &&
                    (material.alpha_mode == AlphaMode::mask ? material.base_color.a >= material.alpha_cutoff
                                                            : material.base_color.a >= 1)));
    kind.thin = !solid && material.transmission.factor > 0;
    kind.two_sided = material.double_sided || kind.thin;
    const bool varies = textured || !vertices.colors.empty() ||
                        (!kind.thin && (has_texture(vertices, material.metal.texture) ||
                                        has_texture(vertices, material.glass.texture))) ||
                        (kind.thin && (has_texture(vertices, material.transmission.color_texture) ||
                                       has_texture(vertices, material.transmission.factor_texture)));
    if (!varies) {
        const float through = kind.thin ? material.transmission.factor : 0.0f;
        const float diffuse = kind.thin ? 1 - through : diffuse_share(material, nullptr);
        kind.constant = {glm::vec3(material.base_color) * diffuse, material.transmission.color * through};
    }
    return kind;
}

glm::vec4 Surfaces::texel(const SurfacePoint& point, const TextureUse& use, bool finest) const {
    const Triangle& triangle = triangles_[point.triangle];
    const VertexArray& vertices = scene_.vertex_arrays[scene_.primitives[triangle.primitive].vertices];
    if (!has_texture(vertices, use))
        return glm::vec4(1);
    const auto& set = vertices.texcoords[static_cast<std::size_t>(use.texcoord)];
    const glm::uvec3 t = triangle.corners - static_cast<unsigned>(vertices.first_receiver);
    const Texture& texture = textures_[static_cast<std::size_t>(use.image)];
    float lod = 0;
    if (!finest) {
        // Isotropic: choose the level at which the footprint has the area of one texel.
        const glm::vec2 size(texture.levels[0].width, texture.levels[0].height);
        const auto coordinate = [&](unsigned i) { return (use.transform * glm::vec3(set[i], 1)) * size; };
        const float texels = doubled_area(coordinate(t.x), coordinate(t.y), coordinate(t.z));
        const glm::vec3& a = vertices.positions[t.x];
        const float area = glm::length(glm::cross(vertices.positions[t.y] - a, vertices.positions[t.z] - a));
        lod = 0.5f * std::log2(point.footprint * texels / area);
        if (!std::isfinite(lod))
            lod = 0;
    }
    return sample(texture, use, use.transform * glm::vec3(interpolated(set, t, point.uv), 1), lod);
}

/// Returns texture values that are not colors; 1 if there is no texture.
glm::vec3 Surfaces::numbers(const SurfacePoint& point, const TextureUse& use) const {
    glm::vec3 values(texel(point, use, false));
    const bool loaded = use.image >= 0 && static_cast<std::size_t>(use.image) < textures_.size();
    if (loaded && textures_[static_cast<std::size_t>(use.image)].encoding == TextureEncoding::srgb)
        for (int c = 0; c < 3; ++c) // this image is used as a color elsewhere
            values[c] = srgb_encode(values[c]);
    return values;
}

/// Share of the base color that is reflected diffusely (docs/math.md, section 6): metals reflect in a mirror
/// lobe that approaches a diffuse lobe with increasing roughness; glass transmits the rest. Without a point
/// textures count as 1.
float Surfaces::diffuse_share(const Material& material, const SurfacePoint* point) const {
    float metallic = material.metal.factor, roughness = material.metal.roughness, glass = 1;
    if (point) {
        const glm::vec3 texel = numbers(*point, material.metal.texture);
        metallic *= texel.b;
        roughness *= texel.g;
        glass = numbers(*point, material.glass.texture).r;
    }
    return (1 - metallic * (1 - roughness * roughness)) * left_of_glass(material, glass);
}

glm::vec4 Surfaces::base_color(const SurfacePoint& point, bool finest) const {
    const Triangle& triangle = triangles_[point.triangle];
    const Primitive& primitive = scene_.primitives[triangle.primitive];
    const VertexArray& vertices = scene_.vertex_arrays[primitive.vertices];
    const Material& material = scene_.materials[primitive.material];
    glm::vec4 base = material.base_color * texel(point, material.base_color_texture, finest);
    if (!vertices.colors.empty())
        base *= interpolated(vertices.colors,
                             triangle.corners - static_cast<unsigned>(vertices.first_receiver), point.uv);
    return base;
}

bool Surfaces::emits(std::uint32_t triangle) const {
    const Emission& emission = material(triangle).emission;
    return emission.radiance != glm::vec3(0) && !is_missing(emission.texture, textures_);
}

glm::vec3 Surfaces::emission(const SurfacePoint& point) const {
    const Emission& emission = material(point.triangle).emission;
    if (!emits(point.triangle))
        return glm::vec3(0);
    if (emission.texture.image < 0)
        return emission.radiance;
    return emission.radiance * glm::vec3(texel(point, emission.texture, false));
}

float Surfaces::coverage(const SurfacePoint& point) const {
    if (opaque(point.triangle))
        return 1;
    const Material& m = material(point.triangle);
    float covered = 1;
    if (m.alpha_mode == AlphaMode::mask)
        covered = base_color(point, true).a >= m.alpha_cutoff ? 1.0f : 0.0f;
    else if (m.alpha_mode == AlphaMode::blend)
        covered = std::clamp(base_color(point, false).a, 0.0f, 1.0f);
    if (m.glass.factor > 0)
        covered *= 1 - glass_transmittance(m) * numbers(point, m.glass.texture).r;
    return covered;
}

Scattering Surfaces::scattering(const SurfacePoint& point) const {
    const Kind& kind = kinds_[triangles_[point.triangle].primitive];
    if (kind.constant)
        return *kind.constant;
    const glm::vec3 base(base_color(point, false));
    if (!kind.thin)
        return {base * diffuse_share(material(point.triangle), &point), glm::vec3(0)};
    const DiffuseTransmission& transmission = material(point.triangle).transmission;
    const float through =
        std::clamp(transmission.factor * texel(point, transmission.factor_texture, false).a, 0.0f, 1.0f);
    return {base * (1 - through),
            through * transmission.color * glm::vec3(texel(point, transmission.color_texture, false))};
}

} // namespace prt

#pragma once

// Properties of the surfaces that rays hit: coverage, reflection, transmission and emission of every triangle
// of a scene.

#include "prt/load/scene.h"
#include "prt/render/texture.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace prt {

/// A point on a triangle, with the area over which its textures are filtered.
struct SurfacePoint {
    std::uint32_t triangle; ///< index among the triangles of all primitives, in the order of
                            ///< Scene::primitives
    glm::vec2 uv;           ///< barycentric coordinates for corners 1 and 2, 0..1
    float footprint;        ///< area of the surface over which textures are filtered, m²; 0: finest level
};

/// Lambertian scattering of a surface, linear Rec. 709.
struct Scattering {
    glm::vec3 reflected, ///< fraction of the irradiance on one side that leaves from the same side, 0..1
        transmitted;     ///< fraction of the irradiance on one side that leaves from the other side, 0..1
};

/// Properties of a scene. Each member is true if at least one surface of the scene has the property.
struct SurfaceTraits {
    bool alpha = false;        ///< the surface can let rays pass: it is cut out, blended, or glass (not
                               ///< `opaque`)
    bool textured = false;     ///< scattering can vary over the surface by textures or vertex colors, or the
                               ///< surface can let rays pass
    bool transmission = false; ///< the surface transmits diffuse light as a thin sheet
    bool color = false;        ///< the base color or its texture, the vertex colors, or the color of light
                               ///< that a thin sheet transmits is not grey
    bool scattering = false;   ///< the surface reflects or transmits any diffuse light
};

/// Optical properties of all triangles of a scene. Immutable, therefore thread-safe. A parameter `triangle`
/// is an index as in SurfacePoint::triangle.
class Surfaces {
public:
    /// Keeps references to `scene` and `textures`. `textures`: load_textures(scene), or empty to ignore all
    /// textures. `solid` [materials]: true for a material with a medium inside, which is then not a thin
    /// sheet; empty: false for all.
    Surfaces(const Scene& scene, const std::vector<Texture>& textures, const std::vector<bool>& solid = {});

    const Scene& scene() const { return scene_; }
    /// Returns the number of triangles of all primitives.
    std::size_t triangles() const { return triangles_.size(); }
    /// Returns the vertices at corners 0, 1 and 2 of the triangle, as indices of the scene's receivers.
    const glm::uvec3& corners(std::uint32_t triangle) const { return triangles_[triangle].corners; }
    /// Returns the index of the triangle's primitive in Scene::primitives.
    std::size_t primitive(std::uint32_t triangle) const { return triangles_[triangle].primitive; }
    /// Returns whether the vertices of the triangle have lobes, and therefore no transfer.
    bool has_lobes(std::uint32_t triangle) const {
        return scene_.vertex_arrays[scene_.primitives[primitive(triangle)].vertices].lobes;
    }
    /// Returns the material of the triangle's primitive.
    const Material& material(std::uint32_t triangle) const {
        return scene_.materials[scene_.primitives[triangles_[triangle].primitive].material];
    }

    /// Returns the properties of the whole scene.
    const SurfaceTraits& traits() const { return traits_; }
    /// Returns whether all texels of the texture of `use` have equal red, green and blue. True if the texture
    /// does not exist or is not loaded.
    bool is_grey(const TextureUse& use) const;
    /// Returns whether the material of the triangle emits light. False if its emission has a texture that
    /// could not be loaded.
    bool emits(std::uint32_t triangle) const;

    /// Returns whether the texture of `use` is loaded and `vertices` have the UV set that it needs.
    bool has_texture(const VertexArray& vertices, const TextureUse& use) const;
    /// Returns whether the triangle certainly stops all rays: `coverage` is then 1 at all its points. False
    /// if a texture or vertex colors can let rays pass; their values are not evaluated.
    bool opaque(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].opaque; }
    /// Returns whether both sides of the triangle scatter light: its material is double-sided, or it is a
    /// thin sheet. If false, the back of the triangle is black.
    bool two_sided(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].two_sided; }
    /// Returns whether the triangle transmits diffuse light as a thin sheet; false for solids.
    bool transmits(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].thin; }
    /// Returns whether the material of the triangle has a medium inside (`solid` of the constructor). All
    /// light that leaves such a surface has passed the medium.
    bool solid(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].solid; }
    /// Returns the fraction of a ray that the surface stops at `point`, 0..1; the rest passes straight on.
    /// The value is c (1 - g): c is 1 for opaque materials, 0 or 1 for cut-outs, and alpha for blended
    /// materials; g is the transmittance of glass, and 0 for all other materials. Cut-outs ignore the
    /// footprint, because many rays average the texture.
    float coverage(const SurfacePoint& point) const;
    /// Returns the diffuse scattering of the part of the surface that stops rays, at `point`.
    Scattering scattering(const SurfacePoint& point) const;
    /// Returns the scattering that all points of the triangle share; no value if textures or vertex colors
    /// can vary it.
    std::optional<Scattering> constant_scattering(std::uint32_t triangle) const {
        return kinds_[triangles_[triangle].primitive].constant;
    }
    /// Returns the radiance that the surface emits at `point`, linear Rec. 709; 0 unless `emits`. It applies
    /// to the front, and to the back if the material is double-sided; the caller checks the side.
    glm::vec3 emission(const SurfacePoint& point) const;
    /// Returns the base color at `point`, linear Rec. 709: factor times texture times vertex color, without
    /// alpha.
    glm::vec3 base_color(const SurfacePoint& point) const { return glm::vec3(base_color(point, false)); }

private:
    struct Triangle {
        glm::uvec3 corners;
        std::uint32_t primitive;
    };
    struct Kind {
        bool opaque = true, two_sided = false, thin = false, solid = false;
        std::optional<Scattering> constant; ///< no value if textures or vertex colors vary the scattering
    };
    Kind kind_of(const Primitive& primitive, bool solid) const;
    glm::vec4 texel(const SurfacePoint& point, const TextureUse& use, bool finest) const;
    glm::vec3 numbers(const SurfacePoint& point, const TextureUse& use) const;
    float diffuse_share(const Material& material, const SurfacePoint* point) const;
    glm::vec4 base_color(const SurfacePoint& point, bool finest) const;

    const Scene& scene_;
    const std::vector<Texture>& textures_;
    std::vector<Triangle> triangles_;
    std::vector<Kind> kinds_; ///< [primitives]
    SurfaceTraits traits_;
};

} // namespace prt

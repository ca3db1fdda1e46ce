#pragma once

// Properties of the surfaces that rays hit: coverage, reflection, transmission and emission of every triangle
// of a scene.

#include "prt/scene.h"
#include "prt/texture.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace prt {

/// A point on a triangle, with the area over which its textures are filtered.
struct SurfacePoint {
    std::uint32_t triangle; ///< index in the order of the scene's primitives and their triangles
    glm::vec2 uv;           ///< barycentric coordinates of corners 1 and 2
    float footprint;        ///< area over which textures are filtered, m²
};

/// Lambertian scattering of a surface, linear Rec. 709: the fraction of the irradiance on one side that
/// leaves on the same side (`reflected`), and the fraction that leaves on the other side (`transmitted`).
struct Scattering {
    glm::vec3 reflected, transmitted;
};

/// Properties of a scene; each is true if at least one surface has it.
struct SurfaceTraits {
    bool alpha = false;        ///< lets rays pass: cut out, blended, or glass
    bool textured = false;     ///< has a texture to filter
    bool transmission = false; ///< transmits diffuse light
    bool color = false;        ///< reflects or transmits red, green and blue differently
    bool scattering = false;   ///< reflects or transmits at all
};

class Surfaces {
public:
    /// Keeps references to `scene` and `textures` (load_textures(scene), or empty to ignore textures).
    /// `solid` [materials]: materials with a medium inside, which are not thin sheets; empty: none.
    Surfaces(const Scene& scene, const std::vector<Texture>& textures, const std::vector<bool>& solid = {});

    const Scene& scene() const { return scene_; }
    std::size_t triangles() const { return triangles_.size(); }
    /// Returns the receivers (vertices) at the corners of the triangle.
    const glm::uvec3& corners(std::uint32_t triangle) const { return triangles_[triangle].corners; }
    std::size_t primitive(std::uint32_t triangle) const { return triangles_[triangle].primitive; }
    const Material& material(std::uint32_t triangle) const {
        return scene_.materials[scene_.primitives[triangles_[triangle].primitive].material];
    }

    const SurfaceTraits& traits() const { return traits_; }
    /// Returns whether all texels of the texture are grey; true if there is no texture.
    bool is_grey(const TextureUse& use) const;
    /// Returns whether the triangle emits light; false if the texture of its emission is missing.
    bool emits(std::uint32_t triangle) const;

    /// Returns whether the texture is loaded and `vertices` have coordinates for it.
    bool has_texture(const VertexArray& vertices, const TextureUse& use) const;
    /// Returns whether no ray passes the surface.
    bool opaque(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].opaque; }
    /// Returns whether both sides of the surface scatter light.
    bool two_sided(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].two_sided; }
    /// Returns whether the surface transmits diffuse light as a thin sheet.
    bool transmits(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].thin; }
    /// Returns whether there is a medium inside, through which all light that leaves the surface has passed.
    bool solid(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].solid; }
    /// Returns the share of a ray that the surface stops: 1 if it is opaque, 0 if it is cut out, alpha if it
    /// is blended; this is multiplied by the share that glass does not transmit. Cut-outs use the finest
    /// level of the texture, because many rays average it.
    float coverage(const SurfacePoint& point) const;
    /// Returns the scattering at a point.
    Scattering scattering(const SurfacePoint& point) const;
    /// Returns the scattering of all points of the triangle; no value if it varies.
    std::optional<Scattering> constant_scattering(std::uint32_t triangle) const {
        return kinds_[triangles_[triangle].primitive].constant;
    }
    /// Returns the radiance that the surface emits.
    glm::vec3 emission(const SurfacePoint& point) const;
    glm::vec3 base_color(const SurfacePoint& point) const { return glm::vec3(base_color(point, false)); }

private:
    struct Triangle {
        glm::uvec3 corners;
        std::uint32_t primitive;
    };
    struct Kind {
        bool opaque = true, two_sided = false, thin = false, solid = false;
        std::optional<Scattering> constant; ///< set if neither textures nor vertex colors vary it
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

#pragma once

// What rays meet: how every triangle of a scene covers, reflects and transmits light.

#include "prt/scene.h"
#include "prt/texture.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace prt {

/// A point on a triangle, seen with a certain blur.
struct SurfacePoint {
    std::uint32_t triangle; ///< in the order of the scene's primitives and their triangles
    glm::vec2 uv;           ///< barycentric coordinates of corners 1 and 2
    float footprint;        ///< area to filter textures over, m²
};

/// Lambertian scattering of a surface: of the irradiance on one side, `reflected` leaves on the same side and
/// `transmitted` on the other. Linear Rec. 709.
struct Scattering {
    glm::vec3 reflected, transmitted;
};

/// What some surface of a scene does.
struct SurfaceTraits {
    bool alpha = false;        ///< lets rays through: cut out, blended, or glass
    bool textured = false;     ///< has a texture to filter
    bool transmission = false; ///< lets diffuse light through
    bool color = false;        ///< reflects or transmits red, green and blue differently
    bool scattering = false;   ///< reflects or transmits at all
};

class Surfaces {
public:
    /// Keeps references to `scene` and `textures` (load_textures(scene), or empty to leave textures out).
    /// `solid` [materials]: materials with something inside, which are no thin sheets; empty: none.
    Surfaces(const Scene& scene, const std::vector<Texture>& textures, const std::vector<bool>& solid = {});

    const Scene& scene() const { return scene_; }
    std::size_t triangles() const { return triangles_.size(); }
    /// Receivers (vertices) at the corners.
    const glm::uvec3& corners(std::uint32_t triangle) const { return triangles_[triangle].corners; }
    std::size_t primitive(std::uint32_t triangle) const { return triangles_[triangle].primitive; }
    const Material& material(std::uint32_t triangle) const {
        return scene_.materials[scene_.primitives[triangles_[triangle].primitive].material];
    }

    const SurfaceTraits& traits() const { return traits_; }
    /// The texture, if there is one, holds no color.
    bool is_grey(const TextureUse& use) const;
    /// Whether the triangle shines: not where the texture of its emission is missing.
    bool emits(std::uint32_t triangle) const;

    /// The texture is loaded and `vertices` have coordinates for it.
    bool has_texture(const VertexArray& vertices, const TextureUse& use) const;
    bool opaque(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].opaque; }
    /// Both sides of the surface scatter light.
    bool two_sided(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].two_sided; }
    /// Diffuse light passes.
    bool transmits(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].thin; }
    /// Something is inside, which all light passes that the surface sends out.
    bool solid(std::uint32_t triangle) const { return kinds_[triangles_[triangle].primitive].solid; }
    /// Share of a ray that the surface stops: 1 where it is opaque, 0 where it is cut out, alpha where it is
    /// blended, and of that what glass does not let through. Cut-outs are decided at the finest level of the
    /// texture, as rays average by themselves.
    float coverage(const SurfacePoint& point) const;
    Scattering scattering(const SurfacePoint& point) const;
    /// The same for all points of the triangle; nothing where it varies.
    std::optional<Scattering> constant_scattering(std::uint32_t triangle) const {
        return kinds_[triangles_[triangle].primitive].constant;
    }
    /// Radiance that the surface gives off by itself.
    glm::vec3 emission(const SurfacePoint& point) const;
    glm::vec3 base_color(const SurfacePoint& point) const { return glm::vec3(base_color(point, false)); }

private:
    struct Triangle {
        glm::uvec3 corners;
        std::uint32_t primitive;
    };
    struct Kind {
        bool opaque = true, two_sided = false, thin = false, solid = false;
        std::optional<Scattering> constant; ///< where neither textures nor vertex colors vary it
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

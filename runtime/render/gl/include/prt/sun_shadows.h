#pragma once

// Shadow maps of suns, for fragment shaders that include `shaders/sun_light.glsl`. Experimental.

#include "prt/gl_scene.h"
#include "prt/sun.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// Maximum number of suns with shadow maps in one picture.
inline constexpr int kMaxShadowedSuns = 4;

/// Shadows of the suns of a picture. Every triangle of a material that casts shadows blocks light from both
/// sides, according to its coverage: texture cut-outs, blending and glass block partially. Behind several
/// partially transparent layers, the light is the product of their transmittances; between two layers,
/// absorption is assumed uniform along the ray. The softness of shadows follows the angular size of the suns.
class SunShadows {
public:
    /// `largest_map`: maximum number of texels along a side of a shadow map. Keeps a reference to `scene`,
    /// whose textures must have been loaded with TextureNeeds::all or TextureNeeds::visibility.
    explicit SunShadows(const GlScene& scene, int largest_map = 4096);

    /// View of the picture for which the maps are drawn.
    struct View {
        Camera camera;
        int width, height; ///< size of the picture, pixels

        friend bool operator==(const View&, const View&) = default;
    };
    /// Moving shadow casters in addition to the scene.
    struct Moving {
        /// Draws both sides of all moving geometry into map `map` of `size` texels, with a program that is
        /// built from sun_caster.vert (with PRT_SKINNED for skins) and gets its uniforms from `set_map`.
        /// Empty: nothing moves.
        std::function<void(int map, int size)> draw;
        Bounds box{};              ///< bounding box of all moving geometry
        std::uint64_t version = 0; ///< changes when the geometry has moved
    };
    /// Sets the uniforms for map `map` of `size` texels in `program`, which must be in use.
    static void set_map(const GlObject& program, int map, int size);

    /// Draws the maps for the view frustum of `view`, unless suns, view and moving geometry are unchanged.
    /// Changes the bound framebuffer, the viewport and the program. Throws `Error` for more than
    /// kMaxShadowedSuns suns and if memory runs out.
    void draw(std::span<const Sun> suns, const View& view, const Moving& moving);
    void draw(std::span<const Sun> suns, const View& view) { draw(suns, view, Moving()); }

    /// Binds the maps and suns that `shaders/sun_light.glsl` reads.
    void use() const;

private:
    struct Maps {
        GlObject depth, layers, passes, framebuffer;
        int count = 0; ///< layers of the textures
    };
    void resize(int size, int count);
    void draw_map(int map, const Moving& moving) const;
    void draw_blocking(const GlObject& program, int map) const;
    void draw_partly_blocking(int map) const;

    const GlScene& scene_;
    Bounds box_;
    int largest_map_, size_ = 0;
    bool layered_ = false;
    GlVertexArrays casters_;
    GlObject blocking_, partly_; ///< programs
    Maps maps_;
    GlObject suns_;
    struct Drawn {
        std::vector<Sun> suns;
        View view{};
        std::uint64_t moved = 0;
    };
    Drawn drawn_;
};

} // namespace prt

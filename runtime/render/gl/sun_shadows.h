#pragma once

// Shadow maps of suns, for fragment shaders that include `shaders/sun_light.glsl`. Experimental.

#include "prt/core/light.h"
#include "runtime/render/gl/gl_scene.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// Maximum number of suns with shadow maps in one picture.
inline constexpr int kMaxShadowedSuns = 4;

/// Shadow maps of the suns of a picture. Every triangle of a material with `casts_shadow` blocks light from
/// both sides. Cut-outs pass all light; blended surfaces and glass pass a part. Behind several such layers
/// the light is the product of their transmittances; between the first and the last layer, the absorption is
/// assumed uniform along the ray. The width of penumbrae follows Sun::half_angle, up to 1.2 radians. An
/// OpenGL 4.5 context must be current for all functions.
class SunShadows {
public:
    /// Builds the programs, but no maps. Keeps a reference to `scene`, which must outlive this object. The
    /// textures of `scene` must be empty, or loaded with TextureNeeds::all or TextureNeeds::visibility.
    /// `largest_map`: maximum number of texels along a side of a shadow map. This number is always at least
    /// 256; above 256 all maps together have at most 2^26 texels. Throws `Error` if the driver cannot build
    /// the programs, or if GPU memory runs out.
    explicit SunShadows(const GlScene& scene, int largest_map = 4096);

    /// View of the picture for which the maps are drawn.
    struct View {
        Camera camera;     ///< relative to Scene::origin
        int width, height; ///< size of the picture, pixels; determines the resolution of the maps

        friend bool operator==(const View&, const View&) = default;
    };
    /// Moving shadow casters, which block all light, in addition to the scene.
    struct Moving {
        /// Function that draws both sides of all moving geometry into map number `map` of size x size texels.
        /// SunShadows::draw calls this function once for each map that it draws, with the framebuffer bound.
        /// The function uses a program from sun_caster.vert and sun_caster.frag, with `#define PRT_SKINNED`
        /// for skins, and sets its uniforms with `set_map`. Empty: there are no moving casters.
        std::function<void(int map, int size)> draw;
        Bounds box{}; ///< box that contains all moving geometry, metres, relative to Scene::origin; unused if
                      ///< `draw` is empty
        std::uint64_t version = 0; ///< any number that the caller changes when the geometry has moved
    };
    /// Sets the uniforms of sun_caster.vert in `program`, which must be in use. `map` and `size`: arguments
    /// of Moving::draw.
    static void set_map(const GlObject& program, int map, int size);

    /// Draws the maps of all `suns`, fitted to the part of the scene that `view` shows. Does nothing if suns,
    /// view and `moving.version` are equal to those of the last successful call; does not compare the other
    /// members of `moving`. Changes the bound framebuffer, vertex array, storage buffers and textures, the
    /// viewport, the program in use, and depth, blend and scissor state; disables face culling. Throws
    /// `Error` for more than kMaxShadowedSuns suns, for an invalid camera (`camera_frame`), if GPU memory
    /// runs out, and if the device does not support maps of the required size.
    void draw(std::span<const Sun> suns, const View& view, const Moving& moving);
    /// Draws the maps like the other overload, without moving casters.
    void draw(std::span<const Sun> suns, const View& view) { draw(suns, view, Moving()); }

    /// Binds the maps and suns that `shaders/sun_light.glsl` reads, for subsequent draws of the picture. Call
    /// `draw` at least once before.
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

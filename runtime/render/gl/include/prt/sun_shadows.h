#pragma once

// Shadow maps of suns, for fragment shaders that include `shaders/sun_light.glsl`. Experimental.

#include "prt/gl_scene.h"
#include "prt/sun_disc.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// As many as one picture has shadow maps for.
inline constexpr int kMostShadowedSuns = 4;

/// The suns of a picture and what blocks them. Every triangle of a material that casts shadows blocks from
/// both sides, as it covers: cut out by its texture, blended or glass in part. Behind several layers that
/// let a part through, light is what they pass together; between two of them it is taken as if they were
/// spread evenly over the way. Shadows are as soft as the suns are wide.
class SunShadows {
public:
    /// `largest_map`: texels along a side. Keeps a reference to `scene`, whose textures were loaded for all
    /// needs or for visibility.
    explicit SunShadows(const GlScene& scene, int largest_map = 4096);

    struct View {
        Camera camera;
        int width, height; ///< of the picture, pixels

        friend bool operator==(const View&, const View&) = default;
    };
    /// What casts shadows beside the scene and moves.
    struct Moving {
        /// Draws both sides of all of it with a program of sun_caster.vert (and PRT_SKINNED), for map `map`
        /// of `size` texels: `set_map` sets what the program is told of it. Nothing: none moves.
        std::function<void(int map, int size)> draw;
        Bounds box{};              ///< around all of it
        std::uint64_t version = 0; ///< another one where it has moved
    };
    /// Tells `program`, which is in use, of the map that is drawn.
    static void set_map(const GlObject& program, int map, int size);

    /// Draws the maps for what `view` sees, where suns, view or what moves are others than before. Changes
    /// the bound framebuffer, the viewport and the program. Throws `Error` for more than kMostShadowedSuns
    /// and when memory runs out.
    void draw(std::span<const SunDisc> suns, const View& view, const Moving& moving);
    void draw(std::span<const SunDisc> suns, const View& view) { draw(suns, view, Moving()); }

    /// Binds all that the shaders read.
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
        std::vector<SunDisc> suns;
        View view{};
        std::uint64_t moved = 0;
    };
    Drawn drawn_;
};

} // namespace prt

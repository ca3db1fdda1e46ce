#pragma once

// Surfaces that a mesh contains twice, once for each side.

#include "bake/scene/ray_scene.h"
#include "prt/load/scene.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace prt {

/// Pairs of triangles of one vertex array that have the same corners in opposite order and single-sided
/// materials. The visible surface is the one whose front faces the ray. Rays hit only the first of two in one
/// primitive, so that a surface that stops a share of a ray stops it once.
class OppositeTriangles {
public:
    explicit OppositeTriangles(const Scene& scene);

    bool empty() const { return of_.empty(); }
    /// Returns the triangle that rays hit in place of `triangle`: most triangles themselves.
    unsigned traced(unsigned triangle) const {
        return of_.empty() || of_[triangle].traced == kNone ? triangle : of_[triangle].traced;
    }
    /// Replaces a hit on the back of `triangle` at barycentric coordinates `uv` by the same point on the
    /// opposite triangle, whose front is visible there. Returns whether an opposite triangle exists.
    bool move_to_front(unsigned& triangle, glm::vec2& uv) const;
    /// Returns `hit`; a hit on the back of such a triangle is moved to the front of the opposite one.
    Hit shown(Hit hit) const;

private:
    static constexpr std::uint32_t kNone = ~0u;
    struct Opposite {
        std::uint32_t triangle = kNone, traced = kNone;
        std::array<std::uint8_t, 3> corners{}; ///< for each corner of this triangle the corner of the hit
                                               ///< triangle
    };
    std::vector<Opposite> of_; ///< [triangles]; empty if there are no pairs
};

} // namespace prt

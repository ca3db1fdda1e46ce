#pragma once

// Surfaces that a mesh holds twice, once for each side.

#include "prt/scene.h"
#include "prt/tracer.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace prt {

/// Triangles of one vertex array that have the same corners in opposite order, of single-sided materials. A
/// ray meets both at once; the front of one is what shows there.
class OppositeTriangles {
public:
    explicit OppositeTriangles(const Scene& scene);

    bool empty() const { return of_.empty(); }
    /// Replaces a hit on the back of `triangle` at barycentric coordinates `uv` by the same point of the
    /// triangle that shows its front there. Returns whether there is one.
    bool turn_to_front(unsigned& triangle, glm::vec2& uv) const;
    /// `hit`, or where it is on the back of such a triangle, the same on the front of the other.
    Hit shown(Hit hit) const;

private:
    static constexpr std::uint32_t kNone = ~0u;
    struct Opposite {
        std::uint32_t triangle = kNone;
        std::array<std::uint8_t, 3> corners{}; ///< of the triangle that was met, at those of this one
    };
    std::vector<Opposite> of_; ///< [triangles], or none
};

} // namespace prt

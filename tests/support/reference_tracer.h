#pragma once

// Direct transfer by another way than the baker's, to judge it by: only Embree is shared. Own starts of rays,
// own samples (jittered strata), own basis (bands 0 to 2 as polynomials).

#include "prt/scene.h"

#include <array>
#include <vector>

namespace prt::test {

using Order3 = std::array<double, 9>;

struct ReferenceTransfer {
    std::vector<Order3> vectors; ///< [receivers]
    /// [receivers] Relative L2 of `other` [receivers][9] against this, weighted by `areas`.
    double relative_l2(const std::vector<float>& other, const std::vector<float>& areas) const;
};

/// Rays start a millionth of the scene's size above the faces of a vertex, along the sum of their normals
/// (the open side of all of them, where they are no worse than a corner of a box), whatever the vertex's
/// normal. `rays` is a square.
ReferenceTransfer reference_transfer(const Scene& scene, int rays);

} // namespace prt::test

#pragma once

// Computes direct transfer independently of the baker, as a reference: only Embree is shared. Ray origins,
// samples (jittered strata) and basis (bands 0 to 2 as polynomials) are implemented separately.

#include "prt/load/scene.h"

#include <array>
#include <vector>

namespace prt::test {

using Order3 = std::array<double, 9>;

struct ReferenceTransfer {
    std::vector<Order3> vectors; ///< [receivers]
    /// [receivers] Relative L2 of `other` [receivers][9] against this, weighted by `areas`.
    double relative_l2(const std::vector<float>& other, const std::vector<float>& areas) const;
};

/// Rays start a millionth of the scene's size above the faces of a vertex, along the sum of their normals (on
/// the open side of all of them, if they form no worse corner than a box), independent of the vertex's
/// normal. `rays` must be a square number.
ReferenceTransfer reference_transfer(const Scene& scene, int rays);

} // namespace prt::test

#pragma once

// Keeps instances from giving more light than comes in.

#include "prt/instances.h"

#include <array>
#include <span>
#include <vector>

namespace prt {

/// Exit radiance of a mesh's receivers under radiance 1 from everywhere, mode by mode. Least squares may take
/// the sum of the modes above 1, where no surface is (docs/math.md, section 22). Immutable, thread-safe.
class UniformBound {
public:
    /// `places` [receivers] in the box of the mesh.
    UniformBound(const SharedTransfer& shared, std::span<const glm::vec3> places);

    /// The same factors where no receiver gives more than 1, or than it gives in the open; else all of them
    /// times the largest share that does.
    InstanceFactors bounded(InstanceFactors factors) const;

private:
    float largest(const InstanceFactors& factors) const;

    std::vector<std::array<glm::vec3, kInstanceModes>> modes_; ///< [receivers]
    std::vector<glm::vec3> places_;
    float bound_ = 1;
};

} // namespace prt

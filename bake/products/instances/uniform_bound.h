#pragma once

// Prevents instances from emitting more light than they receive.

#include "prt/core/instances.h"

#include <array>
#include <span>
#include <vector>

namespace prt {

/// Exit radiance of a mesh's receivers under uniform radiance 1, mode by mode. A least-squares fit may make
/// the sum of the modes larger than 1, which no surface reflects (docs/math.md, section 22). Const members
/// are thread-safe.
class UniformBound {
public:
    /// `positions` [receivers]: positions in the box of the mesh.
    UniformBound(const SharedTransfer& shared, std::span<const glm::vec3> positions);

    /// Maximum exit radiance of a receiver: 1, or the maximum in the open.
    float bound() const { return bound_; }
    /// Largest factor, at most 1, by which to multiply `factors` so that no receiver exceeds the bound.
    float share(const InstanceFactors& factors) const;

    /// Returns up to `most` violated constraints, worst first: for each receiver its radiance per unit
    /// factor, in the brightest channel, or in the first one if all are equal.
    std::vector<InstanceFactors> exceeding(const InstanceFactors& factors, std::size_t most) const;

    /// Removes receivers that are not near the bound with any of `factors`: rounding does not change that.
    void keep_near(std::span<const InstanceFactors> factors);

private:
    InstanceFactors row_of(std::size_t receiver, int channel) const;

    std::vector<std::array<glm::vec3, kInstanceModes>> modes_; ///< [receivers]
    std::vector<glm::vec3> positions_;
    float bound_ = 1;
};

/// Returns all factors multiplied by `share`.
InstanceFactors scaled(InstanceFactors factors, float share);

} // namespace prt

#pragma once

// Keeps instances from giving more light than comes in.

#include "prt/instances.h"

#include <array>
#include <span>
#include <vector>

namespace prt {

/// Exit radiance of a mesh's receivers under radiance 1 from everywhere, mode by mode. Least squares may take
/// the sum of the modes above 1, where no surface is (docs/math.md, section 22). Threads may share what is
/// const.
class UniformBound {
public:
    /// `places` [receivers] in the box of the mesh.
    UniformBound(const SharedTransfer& shared, std::span<const glm::vec3> places);

    /// The most that a receiver may give: 1, or what one gives in the open.
    float bound() const { return bound_; }
    /// The largest share of the factors, 1 at most, with which no receiver gives more.
    float share(const InstanceFactors& factors) const;

    /// Of receivers that give more the worst, so many at most: what each gives, number by number, of factors
    /// of 1, in the channel where it is most, the first where all are alike.
    std::vector<InstanceFactors> exceeding(const InstanceFactors& factors, std::size_t most) const;

    /// Forgets receivers that with none of `factors` come near the bound: rounding takes none there.
    void keep_near(std::span<const InstanceFactors> factors);

private:
    InstanceFactors row_of(std::size_t receiver, int channel) const;

    std::vector<std::array<glm::vec3, kInstanceModes>> modes_; ///< [receivers]
    std::vector<glm::vec3> places_;
    float bound_ = 1;
};

/// All of them times `share`.
InstanceFactors scaled(InstanceFactors factors, float share);

} // namespace prt

// Tracks light jumps at UV seams.
#include "compress/coding/seam_jumps.h"

#include <algorithm>

namespace prt {

SeamJumps::SeamJumps(std::span<const SeamJump> jumps, const JumpWeights& multipliers)
    : jumps_(jumps), multipliers_(multipliers) {
    for (std::size_t s = 0; s < jumps.size(); ++s)
        for (std::size_t i = 0; i < jumps[s].receivers.size(); ++i)
            if (jumps[s].weights[i] != 0)
                parts_.push_back({jumps[s].receivers[i], static_cast<std::uint32_t>(s), jumps[s].weights[i]});
    std::ranges::stable_sort(parts_, {}, &Part::receiver);
    unite_parts();
    for (std::size_t i = 0; i < parts_.size(); ++i)
        if (i == 0 || parts_[i].receiver != parts_[i - 1].receiver) {
            receivers_.push_back(parts_[i].receiver);
            first_.push_back(i);
        }
    first_.push_back(parts_.size());
}

/// Merges duplicate parts: both sides of a jump may read one receiver, and a side may read it twice.
void SeamJumps::unite_parts() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i)
        if (kept > 0 && parts_[kept - 1].receiver == parts_[i].receiver &&
            parts_[kept - 1].jump == parts_[i].jump)
            parts_[kept - 1].weight += parts_[i].weight;
        else
            parts_[kept++] = parts_[i];
    parts_.resize(kept);
}

std::span<const SeamJumps::Part> SeamJumps::parts_of(std::size_t p) const {
    const auto found = std::ranges::lower_bound(receivers_, p);
    if (found == receivers_.end() || *found != p)
        return {};
    const auto i = static_cast<std::size_t>(found - receivers_.begin());
    return std::span(parts_).subspan(first_[i], first_[i + 1] - first_[i]);
}

void SeamJumps::move(std::size_t p, const Eigen::VectorXf& by) {
    for (const Part& part : parts_of(p))
        sums_.col(part.jump) += part.weight * by;
}

double SeamJumps::pull(std::size_t p, const Eigen::VectorXf& now, Eigen::VectorXf& slope) const {
    double curvature = 0;
    for (const Part& part : parts_of(p)) {
        const double multiplier = multipliers_.square * static_cast<double>(part.weight);
        slope -= static_cast<float>(multiplier) * (sums_.col(part.jump) - part.weight * now);
        curvature += multiplier * static_cast<double>(part.weight);
    }
    return curvature;
}

} // namespace prt

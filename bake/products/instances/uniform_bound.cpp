// Evaluates exit radiance of instances under uniform light, and finds factors that exceed the bound.

#include "bake/products/instances/uniform_bound.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace prt {

UniformBound::UniformBound(const SharedTransfer& shared, std::span<const glm::vec3> positions)
    : modes_(shared.receivers()), positions_(positions.begin(), positions.end()) {
    const auto uniform = static_cast<float>(std::sqrt(4 * std::numbers::pi)); // its only coefficient
    const float on_level = uniform * shared.level()[0];
    const std::size_t count = shared.level().size();
    for (std::size_t r = 0; r < modes_.size(); ++r) {
        modes_[r] = {};
        for (std::size_t m = 0; m < kPassingModes; ++m) {
            std::size_t first = 0;
            for (const TransferTerm& term : shared.layout().terms)
                for (int c = 0; c < term.channels; ++c, first += count)
                    for (int color = term.channels == 1 ? 0 : c; color <= (term.channels == 1 ? 2 : c);
                         ++color)
                        modes_[r][m][color] += uniform * shared.passing(r, m)[first];
        }
        for (std::size_t k = 0; k < kAddedModes; ++k)
            modes_[r][kPassingModes + k] = on_level * shared.responses(r)[k];
    }
    bound_ = std::max(bound_, bound_ / share(open_factors()));
}

float UniformBound::share(const InstanceFactors& factors) const {
    float most = bound_;
    for (std::size_t r = 0; r < modes_.size(); ++r) {
        const glm::vec3 radiance = exit_radiance(factors, positions_[r], modes_[r]);
        most = std::max({most, radiance.x, radiance.y, radiance.z});
    }
    return bound_ / most;
}

InstanceFactors UniformBound::row_of(std::size_t receiver, int channel) const {
    InstanceFactors row;
    for (std::size_t m = 0; m < kPassingModes; ++m)
        row.passing[m] = glm::vec4(positions_[receiver], 1) * modes_[receiver][m][channel];
    for (std::size_t k = 0; k < kAddedModes; ++k)
        row.added[k][channel] = modes_[receiver][kPassingModes + k][channel];
    return row;
}

std::vector<InstanceFactors> UniformBound::exceeding(const InstanceFactors& factors, std::size_t most) const {
    struct Excess {
        float radiance;
        std::size_t receiver;
        int channel;
    };
    std::vector<Excess> all;
    for (std::size_t r = 0; r < modes_.size(); ++r) {
        const glm::vec3 radiance = exit_radiance(factors, positions_[r], modes_[r]);
        const int channel = radiance.x >= radiance.y && radiance.x >= radiance.z ? 0
                            : radiance.y >= radiance.z                           ? 1
                                                                                 : 2;
        if (radiance[channel] > bound_)
            all.push_back({radiance[channel], r, channel});
    }
    std::ranges::sort(all, std::greater(), &Excess::radiance);
    std::vector<InstanceFactors> rows;
    for (std::size_t i = 0; i < std::min(most, all.size()); ++i)
        rows.push_back(row_of(all[i].receiver, all[i].channel));
    return rows;
}

void UniformBound::keep_near(std::span<const InstanceFactors> factors) {
    constexpr float kNear = 0.9f; // quantisation to bytes adds at most two hundredths
    std::size_t kept = 0;
    for (std::size_t r = 0; r < modes_.size(); ++r) {
        const bool near = std::ranges::any_of(factors, [&](const InstanceFactors& f) {
            const glm::vec3 radiance = exit_radiance(f, positions_[r], modes_[r]);
            return std::max({radiance.x, radiance.y, radiance.z}) > kNear * bound_;
        });
        if (!near)
            continue;
        modes_[kept] = modes_[r];
        positions_[kept++] = positions_[r];
    }
    modes_.resize(kept);
    modes_.shrink_to_fit();
    positions_.resize(kept);
}

InstanceFactors scaled(InstanceFactors factors, float share) {
    for (glm::vec4& row : factors.passing)
        row *= share;
    for (glm::vec3& color : factors.added)
        color *= share;
    return factors;
}

} // namespace prt

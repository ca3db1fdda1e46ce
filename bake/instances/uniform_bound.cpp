#include "instances/uniform_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {

UniformBound::UniformBound(const SharedTransfer& shared, std::span<const glm::vec3> places)
    : modes_(shared.receivers()), places_(places.begin(), places.end()) {
    const auto uniform = static_cast<float>(std::sqrt(4 * std::numbers::pi)); // its one coefficient
    const float on_level = uniform * shared.level()[0];
    const std::size_t count = shared.level().size();
    for (std::size_t r = 0; r < modes_.size(); ++r) {
        modes_[r] = {};
        for (std::size_t m = 0; m < kPassingModes; ++m) {
            std::size_t first = 0;
            for (const TransferPart& part : shared.layout().parts)
                for (int c = 0; c < part.channels; ++c, first += count)
                    for (int color = part.channels == 1 ? 0 : c; color <= (part.channels == 1 ? 2 : c);
                         ++color)
                        modes_[r][m][color] += uniform * shared.passing(r, m)[first];
        }
        for (std::size_t k = 0; k < kAddedModes; ++k)
            modes_[r][kPassingModes + k] = on_level * shared.responses(r)[k];
    }
    bound_ = std::max(bound_, largest(open_factors()));
}

float UniformBound::largest(const InstanceFactors& factors) const {
    float most = 0;
    for (std::size_t r = 0; r < modes_.size(); ++r) {
        const glm::vec3 radiance = exit_radiance(factors, places_[r], modes_[r]);
        most = std::max({most, radiance.x, radiance.y, radiance.z});
    }
    return most;
}

InstanceFactors UniformBound::bounded(InstanceFactors factors) const {
    const float share = bound_ / std::max(bound_, largest(factors));
    for (glm::vec4& row : factors.passing)
        row *= share;
    for (glm::vec3& color : factors.added)
        color *= share;
    return factors;
}

} // namespace prt

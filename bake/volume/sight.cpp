#include "volume/sight.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace prt {

void SightSums::add(const glm::vec3& d, float square, float linear) {
    std::array<std::size_t, 3> at{};
    std::array<double, 3> size{};
    for (int a = 0; a < 3; ++a) {
        at[static_cast<std::size_t>(a)] = static_cast<std::size_t>(2 * a + (d[a] > 0 ? 1 : 0));
        size[static_cast<std::size_t>(a)] = static_cast<double>(std::abs(d[a]));
    }
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
            a_[at[i]][at[j]] += static_cast<double>(square) * size[i] * size[j];
        b_[at[i]] += static_cast<double>(linear) * size[i];
    }
}

std::array<float, 6> SightSums::distances() const {
    // Coordinate descent with x >= 0: six numbers, well conditioned as rays go everywhere.
    std::array<double, 6> x{};
    for (int round = 0; round < 60; ++round)
        for (std::size_t i = 0; i < 6; ++i) {
            if (!(a_[i][i] > 0))
                continue;
            double rest = b_[i];
            for (std::size_t j = 0; j < 6; ++j)
                rest -= j == i ? 0 : a_[i][j] * x[j];
            x[i] = std::max(0.0, rest / a_[i][i]);
        }
    std::array<float, 6> distances{};
    for (std::size_t i = 0; i < 6; ++i)
        distances[i] = x[i] > 0 ? static_cast<float>(1 / x[i]) : HUGE_VALF;
    return distances;
}

} // namespace prt

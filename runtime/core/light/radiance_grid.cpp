// Evaluates a light on a grid of directions, and bounds its minimum between them.
#include "runtime/core/light/radiance_grid.h"

#include "prt/core/sh.h"
#include "runtime/core/support/vector_lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;

/// Maximum rounding error of float sums, relative to the range.
constexpr double kRounding = 1e-5;

/// One ring of directions as Fourier sums in the azimuth: cosine[m], sine[m].
struct Ring {
    std::array<glm::vec3, kMaxOrder> cosine{}, sine{};
};

/// Writes the smallest channel in each direction to `lowest` [columns]; returns the maximum of all channels.
PRT_TWO_CLONES
float ring_values(const Ring& ring, int order, const float* cosines, const float* sines, std::size_t columns,
                  float* lowest) {
    Lanes high = Lanes{} - std::numeric_limits<float>::max();
    for (std::size_t first = 0; first < columns; first += kLaneCount) {
        Lanes low = Lanes{} + std::numeric_limits<float>::max();
        for (int c = 0; c < 3; ++c) {
            Lanes value = Lanes{} + ring.cosine[0][c];
            for (std::size_t m = 1; m < static_cast<std::size_t>(order); ++m)
                value += ring.cosine[m][c] * lanes_at(cosines + m * columns + first) +
                         ring.sine[m][c] * lanes_at(sines + m * columns + first);
            low = value < low ? value : low;
            high = value > high ? value : high;
        }
        *reinterpret_cast<LanesInMemory*>(lowest + first) = low;
    }
    float largest = high[0];
    for (int lane = 1; lane < kLaneCount; ++lane)
        largest = std::max(largest, high[lane]);
    return largest;
}

/// Returns coefficients relative to the means. A channel without a positive mean becomes 1 everywhere, which
/// is between the minimum and the maximum of any other channel.
std::vector<glm::vec3> in_shares(const Light& light) {
    std::vector<glm::vec3> result = light.coefficients;
    for (int c = 0; c < 3; ++c) {
        const double mean = usable_mean(light, c);
        for (glm::vec3& v : result)
            v[c] = mean > 0 ? static_cast<float>(static_cast<double>(v[c]) / mean) : 0.0f;
        result[0][c] = static_cast<float>(1 / kY00);
    }
    return result;
}

Ring ring_at(double theta, int order, const std::vector<glm::vec3>& coefficients) {
    std::array<double, kMaxOrder * kMaxOrder> legendre{}; // the basis at azimuth 0
    evaluate_sh(order, glm::dvec3(std::sin(theta), 0, std::cos(theta)), std::span<double>(legendre));
    Ring ring;
    for (int l = 0; l < order; ++l)
        for (int m = 0; m <= l; ++m) {
            const auto i = static_cast<std::size_t>(sh_index(l, m));
            ring.cosine[static_cast<std::size_t>(m)] += static_cast<float>(legendre[i]) * coefficients[i];
            if (m > 0)
                ring.sine[static_cast<std::size_t>(m)] +=
                    static_cast<float>(legendre[i]) * coefficients[static_cast<std::size_t>(sh_index(l, -m))];
        }
    return ring;
}

} // namespace

double usable_mean(const Light& light, int c) {
    constexpr double kMinShare = 1e-6;
    const auto first = static_cast<double>(light.coefficients[0][c]);
    double largest = 0;
    for (const glm::vec3& v : light.coefficients)
        largest = std::max(largest, std::abs(static_cast<double>(v[c])));
    return first > 0 && first >= kMinShare * largest ? kY00 * first : 0;
}

GridRadiance radiance_on_grid(const Light& light, int rows) {
    const auto columns = static_cast<std::size_t>(2 * rows), order = static_cast<std::size_t>(light.order);
    const std::vector<glm::vec3> coefficients = in_shares(light);
    std::vector<float> cosines(order * columns), sines(order * columns), lowest(columns);
    for (std::size_t column = 0; column < columns; ++column) {
        const double azimuth = pi * (static_cast<double>(column) + 0.5) / rows;
        const std::complex<double> rotation(std::cos(azimuth), std::sin(azimuth));
        std::complex<double> power = rotation;
        for (std::size_t m = 1; m < order; ++m, power *= rotation) {
            cosines[m * columns + column] = static_cast<float>(power.real());
            sines[m * columns + column] = static_cast<float>(power.imag());
        }
    }
    GridRadiance result{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest(), {}};
    std::vector<LowPoint> patches(columns / kLaneCount);
    for (int row = 0; row < rows; ++row) {
        const double theta = pi * (row + 0.5) / rows;
        const float largest = ring_values(ring_at(theta, light.order, coefficients), light.order,
                                          cosines.data(), sines.data(), columns, lowest.data());
        result.largest = std::max(result.largest, static_cast<double>(largest));
        const double sine = std::sin(theta), cosine = std::cos(theta);
        for (std::size_t column = 0; column < columns; ++column) {
            result.least = std::min(result.least, static_cast<double>(lowest[column]));
            LowPoint& low = patches[column / kLaneCount];
            if (lowest[column] < low.value) {
                const double azimuth = pi * (static_cast<double>(column) + 0.5) / rows;
                low = {{sine * std::cos(azimuth), sine * std::sin(azimuth), cosine}, lowest[column]};
            }
        }
        if ((row + 1) % kLaneCount == 0)
            for (LowPoint& low : patches) {
                if (low.value < 0)
                    result.points.push_back(low);
                low = {};
            }
    }
    return result;
}

double share_between(int order, int rows) {
    // Every direction is within half the diagonal of a square of pi / rows from a grid point.
    const double rotation = (order - 1) * pi / rows, drop = rotation * rotation / 8;
    return drop / (1 - 2 * drop) + kRounding;
}

int rows_for(int order, double share) {
    const double drop = std::max(share - kRounding, 0.1 * kRounding) / (1 + 2 * share);
    const int rows = static_cast<int>(std::ceil((order - 1) * pi / std::sqrt(8 * drop)));
    return std::max(kLaneCount, (rows + kLaneCount - 1) / kLaneCount * kLaneCount);
}

} // namespace prt

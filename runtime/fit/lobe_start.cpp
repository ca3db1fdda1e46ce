// Start values by matching pursuit over directions on the sphere (Mallat and Zhang 1993): the best profile
// about an axis is the projection of the residual of each band onto the axis.

#include "runtime/fit/lobe_start.h"

#include "prt/core/sh.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace prt {
namespace {

constexpr int kPursuitDirections = 96; ///< spaced about 20 degrees; the nonlinear fit refines them

using Residual = std::array<double, kMaxLobeOrder * kMaxLobeOrder>;

struct Direction {
    glm::dvec3 towards;
    Residual basis{};
};

Direction direction_of(const glm::dvec3& towards) {
    Direction direction{towards};
    evaluate_sh(kMaxLobeOrder, towards, std::span(direction.basis));
    return direction;
}

/// Returns a spherical Fibonacci lattice.
const std::vector<Direction>& directions() {
    static const std::vector<Direction> all = [] {
        std::vector<Direction> lattice;
        for (int i = 0; i < kPursuitDirections; ++i) {
            const double z = 1 - (2 * i + 1.0) / kPursuitDirections, radius = std::sqrt(1 - z * z);
            const double angle = 2 * std::numbers::pi * 0.61803398875 * i;
            lattice.push_back(direction_of({radius * std::cos(angle), radius * std::sin(angle), z}));
        }
        return lattice;
    }();
    return all;
}

/// Returns the sum over m of left_lm Y_lm(axis), which is `band_square` times the best profile.
double along(int l, const Residual& left, const Direction& direction) {
    double sum = 0;
    for (int i = l * l; i < (l + 1) * (l + 1); ++i)
        sum += left[static_cast<std::size_t>(i)] * direction.basis[static_cast<std::size_t>(i)];
    return sum;
}

/// Returns the sum over m of Y_lm².
double band_square(int l) {
    return (2 * l + 1) / (4 * std::numbers::pi);
}

/// Returns the reduction of the squared error by the best lobe about an axis.
double gain_of(int order, const Residual& left, const Direction& direction, const LobeFitOptions& options) {
    double gain = 0;
    for (int l = 0; l < order; ++l) {
        const double found = along(l, left, direction);
        gain += options.band_costs[static_cast<std::size_t>(l)] * found * found / band_square(l);
    }
    return gain;
}

Direction best_direction(int order, const Residual& left, const LobeFitOptions& options) {
    Direction best = directions().front();
    double most = -1;
    const auto ask = [&](const Direction& direction) {
        if (const double gain = gain_of(order, left, direction, options); gain > most) {
            most = gain;
            best = direction;
        }
    };
    // Try the mean direction of the residual first: for an unoccluded vertex it is the normal.
    const glm::dvec3 mean(-left[3], -left[1], left[2]);
    if (const double length = glm::length(mean); length > 1e-9)
        ask(direction_of(mean / length));
    for (const Direction& direction : directions())
        if (gain_of(order, left, direction, options) > most * (1 + 1e-9))
            ask(direction);
    return best;
}

} // namespace

void start_lobes(int order, std::span<const double> target, const LobeFitOptions& options,
                 std::span<FreeLobe> lobes) {
    Residual left{};
    std::copy(target.begin(), target.end(), left.begin());
    for (FreeLobe& lobe : lobes) {
        const Direction direction = best_direction(order, left, options);
        lobe = {direction.towards, {}};
        for (int l = 0; l < order; ++l) {
            const double gain = along(l, left, direction) / band_square(l);
            lobe.profile[static_cast<std::size_t>(l)] = gain;
            for (int i = l * l; i < (l + 1) * (l + 1); ++i)
                left[static_cast<std::size_t>(i)] -= gain * direction.basis[static_cast<std::size_t>(i)];
        }
    }
}

} // namespace prt

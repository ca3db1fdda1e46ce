#pragma once

// Fits probes so that their interpolation matches light measured between them (docs/math.md, section 19).

#include "prt/core/progress.h"
#include "prt/core/transfer_volume.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace prt {

/// Vectors of probes.
struct ProbeVectors {
    std::span<float> values; ///< [probes][stride]
    std::size_t stride = 0;

    std::span<float> of(std::size_t probe) const { return values.subspan(probe * stride, stride); }
};

/// Replaces the values of invalid probes (inside geometry) by the mean of their neighbours, ring by ring,
/// starting next to the valid probes.
void fill_invalid(const VolumeProbes& probes, const std::vector<bool>& invalid, const ProbeVectors& vectors);

/// Replaces the values of hanging probes by interpolated values of the coarse bricks next to them.
void settle_hanging(const VolumeGrid& grid, const VolumeProbes& probes, const ProbeVectors& vectors);

/// Finds probes that minimise sum over points |sum w v - e|² + sum over probes lambda |v - v0|², where v0 are
/// their initial values. Points are added to sums and not stored.
class ProbeFit {
public:
    /// Probes in ascending order, with their weights.
    using Shares = std::vector<std::pair<std::uint32_t, float>>;

    ProbeFit(const VolumeGrid& grid, const VolumeProbes& probes, std::size_t stride);

    /// Adds points: the weights of probes at the points, and the light measured there, [points][stride].
    void add(std::span<const VolumeCorners> points, std::span<const float> vectors, int threads);
    std::size_t points() const { return points_; }

    /// Relative L2 error of interpolation at the points.
    struct Errors {
        double before = 0, after = 0;
    };
    /// Fits the probes. Hanging probes are not changed.
    Errors solve(const ProbeVectors& vectors, int threads, const Progress& progress) const;

private:
    /// Weights at a point, with hanging probes replaced by the probes that they are interpolated from.
    Shares shares_at(const VolumeCorners& point) const;

    std::vector<Shares> shares_; ///< [probes] for a hanging probe the probes that it is interpolated from;
                                 ///< for other probes themselves
    std::size_t stride_ = 0, points_ = 0;
    std::vector<Shares> rows_; ///< [probes] rows of sum w wᵀ from the diagonal on, in order
    std::vector<float> sums_;  ///< [probes][stride] sum w e
    double norm_ = 0;          ///< sum |e|²
};

} // namespace prt

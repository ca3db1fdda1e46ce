#pragma once

// Probes whose interpolation comes nearest to what was measured between them (docs/math.md, section 19).

#include "prt/support/progress.h"
#include "prt/transfer_volume.h"

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

/// Gives blind probes the mean of their neighbours, from those that see on.
void fill_blind(const VolumeProbes& probes, const std::vector<bool>& blind, const ProbeVectors& vectors);

/// Gives hanging probes what is interpolated between those of the coarse bricks they lie on.
void settle_hanging(const VolumeGrid& grid, const VolumeProbes& probes, const ProbeVectors& vectors);

/// Moves probes to min sum over points |sum w v - e|² + sum over probes lambda |v - v0|², v0 what they have.
/// Points are summed up as they come, and not kept.
class ProbeFit {
public:
    /// Probes, in order, with what each counts.
    using Shares = std::vector<std::pair<std::uint32_t, float>>;

    ProbeFit(const VolumeGrid& grid, const VolumeProbes& probes, std::size_t stride);

    /// Probes that count at points, and what was measured there, [points][stride].
    void add(std::span<const VolumeCorners> points, std::span<const float> vectors, int threads);
    std::size_t points() const { return points_; }

    /// Relative L2 of interpolation at the points.
    struct Errors {
        double before = 0, after = 0;
    };
    /// Of hanging probes nothing is moved.
    Errors solve(const ProbeVectors& vectors, int threads, const Progress& progress) const;

private:
    /// Of a point, probes that are no others' mixture.
    Shares shares_at(const VolumeCorners& point) const;

    std::vector<Shares> shares_; ///< [probes] of hanging ones those they are mixed of; of others themselves
    std::size_t stride_ = 0, points_ = 0;
    std::vector<Shares> rows_; ///< [probes] of sum w wᵀ: probes from the row's own on, in order
    std::vector<float> sums_;  ///< [probes][stride] sum w e
    double norm_ = 0;          ///< sum |e|²
};

} // namespace prt

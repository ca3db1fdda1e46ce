#pragma once

// Probes whose interpolation comes nearest to what was measured between them (docs/math.md, section 19).

#include "prt/support/progress.h"
#include "prt/transfer_volume.h"

#include <cstddef>
#include <cstdint>
#include <span>
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

/// Points where light was measured.
struct FitPoints {
    std::vector<VolumeCorners> corners; ///< [points]
    std::vector<float> vectors;         ///< [points][stride]
};

/// Relative L2 of interpolation at points.
double error_at(const FitPoints& points, const ProbeVectors& vectors);

/// Moves probes to min sum over points |sum w v - e|² + sum over probes lambda |v - v0|², v0 what they have.
void fit_probes(const VolumeGrid& grid, const VolumeProbes& probes, const FitPoints& points,
                const ProbeVectors& vectors, int threads, const Progress& progress);

} // namespace prt

#pragma once

// Compression of volumes: a probe is one receiver, whose transfer has a vector for each coefficient of the
// incident light. Experimental.

#include "prt/compress.h"
#include "prt/transfer_volume.h"

namespace prt {

/// Returns the raw transfer of a volume with one receiver per probe.
TransferView as_probes(const BakedVolume& volume);

/// Returns the metric of the relative error of incident light, averaged over all directions, from the metric
/// of exit radiance under the same lightings.
LightMetric incident_metric(const LightMetric& of_one, std::size_t outputs);

/// Returns a coding with sixteen bytes: 8 bits of cluster, 120 bits of weights.
WeightCoding preset_volume();

struct CompressedVolumeResult {
    CompressedVolume volume;
    CompressStatistics statistics;
};

/// Compresses a volume with the options of `compress`. Predictors are disabled, weights must be packed, and a
/// metric is one of exit radiance. Throws as `compress`.
CompressedVolumeResult compress_volume(const BakedVolume& volume, CompressOptions options,
                                       const Progress& progress = {});

} // namespace prt

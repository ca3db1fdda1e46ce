#pragma once

// Compression of volumes. Each probe is one receiver with one output per coefficient of incident light.
// Experimental.

#include "prt/compress.h"
#include "prt/transfer_volume.h"

namespace prt {

/// Returns a view of the raw transfer of `volume` with one receiver per probe. Keeps a reference to it.
TransferView as_probes(const BakedVolume& volume);

/// Returns the metric of incident light, whose error is averaged over all directions, from `of_one`, the
/// metric of exit radiance under the same lightings.
LightMetric incident_metric(const LightMetric& of_one, std::size_t outputs);

/// Returns a coding with sixteen bytes per probe: 8 bits for the cluster and 120 bits for weights.
WeightCoding preset_volume();

/// Result of `compress_volume`.
struct CompressedVolumeResult {
    CompressedVolume volume;
    CompressStatistics statistics;
};

/// Compresses a volume. `options` are those of `compress`: weights must be packed, a metric is one of exit
/// radiance, and predictors are not used. Throws the errors of `compress`.
CompressedVolumeResult compress_volume(const BakedVolume& volume, CompressOptions options,
                                       const Progress& progress = {});

} // namespace prt

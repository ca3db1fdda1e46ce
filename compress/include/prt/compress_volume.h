#pragma once

// Compression of volumes: a probe is one receiver, whose transfer has a vector for each coefficient of the
// light that comes in. Experimental.

#include "prt/compress.h"
#include "prt/transfer_volume.h"

namespace prt {

/// Raw transfer of a volume as that of probes.
TransferView as_probes(const BakedVolume& volume);

/// The metric of the relative error of incident light, all directions alike, from that of exit radiance under
/// the same lightings.
LightMetric incident_metric(const LightMetric& of_one, std::size_t outputs);

/// Sixteen bytes: 8 bits of cluster, 120 of weights.
WeightCoding preset_volume();

struct CompressedVolumeResult {
    CompressedVolume volume;
    CompressStatistics statistics;
};

/// Compresses a volume. Options are those of `compress`; guides are none, weights packed, and a metric is one
/// of exit radiance. Throws as it does.
CompressedVolumeResult compress_volume(const BakedVolume& volume, CompressOptions options,
                                       const Progress& progress = {});

} // namespace prt

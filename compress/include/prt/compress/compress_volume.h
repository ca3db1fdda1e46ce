#pragma once

// Compression of volumes. Each probe is one receiver. Its transfer vector has one output per SH coefficient
// of incident light (TransferLayout::outputs). Experimental.

#include "prt/compress/compress.h"
#include "prt/core/transfer_volume.h"

namespace prt {

/// Returns a view of the raw transfer of `volume` with one receiver per probe and `volume.coefficients()`
/// outputs. The view keeps a reference to `volume`, which must outlive the view.
TransferView as_probes(const BakedVolume& volume);

/// Returns a metric for vectors with `outputs` outputs: 4, 9 or 16, which is not checked. The cost of an
/// error is the sum over the outputs of the cost under `of_one`, a metric of exit radiance (one output). This
/// sum is proportional to the squared error of incident light, averaged over all directions.
LightMetric incident_metric(const LightMetric& of_one, std::size_t outputs);

/// Returns a coding with 128 bits per probe: 8 bits for the cluster index, which allow up to 256 clusters,
/// and 120 bits for weights.
WeightCoding preset_volume();

/// Result of `compress_volume`.
struct CompressedVolumeResult {
    CompressedVolume volume;       ///< grid, order, visibility and record are those of the input
    CompressStatistics statistics; ///< receivers are probes; `sky_contrast` and `lamp_contrast` are 0
};

/// Compresses `volume`. All probes have the same significance. `options` are used as in `compress`, except:
/// `coding.format` must be `packed`, else throws `Error`. `metric` is a metric of exit radiance (one output);
/// without a value it is that of `LightFamily::outdoor`, `balanced`. `predictors` and `seam_weight` are
/// ignored: no predictors are used, and jumps are not reduced. Throws the errors of `compress`.
CompressedVolumeResult compress_volume(const BakedVolume& volume, CompressOptions options,
                                       const Progress& progress = {});

} // namespace prt

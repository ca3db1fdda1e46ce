// Compresses volumes with probes as receivers.
#include "prt/compress/compress.h"

#include "prt/core/error.h"

#include <algorithm>

namespace prt {
namespace {

TransferLayout layout_of_probes(const BakedVolume& volume) {
    TransferLayout layout = volume.baked.transfer.layout;
    layout.outputs = volume.coefficients();
    return layout;
}

} // namespace

TransferView as_probes(const BakedVolume& volume) {
    TransferLayout layout = layout_of_probes(volume);
    const std::size_t dimension = layout.dimension();
    const std::vector<float>& vectors = volume.baked.transfer.vectors;
    return {std::move(layout), dimension == 0 ? 0 : vectors.size() / dimension,
            [&vectors, dimension](std::size_t first, std::span<float> to) {
                std::copy_n(vectors.begin() + static_cast<std::ptrdiff_t>(first * dimension), to.size(),
                            to.begin());
            }};
}

LightMetric incident_metric(const LightMetric& of_one, std::size_t outputs) {
    const std::size_t small = of_one.layout.dimension(), large = outputs * small;
    LightMetric metric{of_one.layout, std::vector<double>(large * large, 0.0)};
    metric.layout.outputs = outputs;
    for (std::size_t o = 0; o < outputs; ++o)
        for (std::size_t i = 0; i < small; ++i)
            std::copy_n(&of_one.moments[i * small], small,
                        &metric.moments[(o * small + i) * large + o * small]);
    return metric;
}

WeightCoding preset_volume() {
    return {.bits = 120, .cluster_bits = 8};
}

CompressedVolumeResult compress_volume(const BakedVolume& volume, CompressOptions options,
                                       const Progress& progress) {
    if (options.coding.format != WeightFormat::packed)
        throw Error("the weights of a volume must be packed; use --bits N");
    const TransferView probes = as_probes(volume);
    const std::vector<float> of_coefficients(volume.baked.transfer.receivers(), 1.0f),
        of_probes(probes.receivers(), 1.0f);
    const TransferLayout& layout = volume.baked.transfer.layout;
    const LightMetric metric = options.metric
                                   ? *options.metric
                                   : balanced(metric_of_family(LightFamily::outdoor, layout),
                                              volume.baked.transfer, of_coefficients, options.threads);
    options.metric = incident_metric(metric, volume.coefficients());
    options.predictors = PredictorChoice::none;
    options.seam_weight = 0;
    CompressResult result = compress(probes, {.areas = of_probes}, options, progress);
    return {{volume, {std::move(result.transfer), volume.baked.record}}, std::move(result.statistics)};
}

} // namespace prt

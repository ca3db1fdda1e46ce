#include "encode.h"

#include "local_pca.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace prt {
namespace {

ClusteredBases make_bases(const ClusterModels& models, const Transfer& shape) {
    ClusteredBases bases{shape.order, shape.channels, models.components, {}, {}};
    for (std::size_t k = 0; k < models.clusters(); ++k) {
        bases.rows.insert(bases.rows.end(), models.mean(k), models.mean(k) + models.dimension);
        for (int j = 0; j < models.components[k]; ++j) {
            const float* direction = models.direction(k, static_cast<std::size_t>(j));
            bases.rows.insert(bases.rows.end(), direction, direction + models.dimension);
        }
    }
    return bases;
}

template <class Stored>
void store(std::byte* to, double value) {
    const auto stored = static_cast<Stored>(value);
    std::memcpy(to, &stored, sizeof stored);
}

void store_weight(std::byte* to, double weight, double scale, WeightFormat format) {
    const double normalised = scale > 0 ? std::clamp(weight / scale, -1.0, 1.0) : 0;
    switch (format) {
    case WeightFormat::float32:
        return store<float>(to, weight);
    case WeightFormat::snorm16:
        return store<std::int16_t>(to, std::round(normalised * 32767));
    case WeightFormat::snorm8:
        return store<std::int8_t>(to, std::round(normalised * 127));
    }
}

} // namespace

ClusteredTransfer encode(const PointBlocks& points, const ClusterModels& models,
                         std::span<const std::uint32_t> clusters, const Transfer& shape,
                         WeightFormat format) {
    ClusteredTransfer result;
    ClusteredBases& bases = result.bases;
    bases = make_bases(models, shape);
    const std::vector<std::size_t> first = bases.first_rows();
    bases.scales.assign(first.back() - bases.clusters(), format == WeightFormat::float32 ? 1.0f : 0.0f);

    const auto most = static_cast<std::size_t>(bases.max_components());
    std::vector<double> weights(points.count * most, 0.0);
    for (std::size_t p = 0; p < points.count; ++p) {
        const std::size_t k = clusters[p];
        project_point(points, p, models, k, std::span(weights).subspan(p * most, most));
        if (format != WeightFormat::float32)
            for (std::size_t j = 0; j < static_cast<std::size_t>(bases.components[k]); ++j) {
                float& scale = bases.scales[first[k] - k + j];
                scale = std::max(scale, static_cast<float>(std::abs(weights[p * most + j])));
            }
    }

    ClusteredReceivers& receivers = result.receivers;
    receivers.format = format;
    receivers.components = (static_cast<int>(most) + 3) / 4 * 4;
    const std::size_t size = bytes_per_weight(format);
    const std::size_t stride = static_cast<std::size_t>(receivers.components) * size;
    receivers.weights.assign(points.count * stride, std::byte{0});
    for (std::size_t p = 0; p < points.count; ++p) {
        const std::size_t k = clusters[p];
        receivers.clusters.push_back(static_cast<std::uint16_t>(k));
        for (std::size_t j = 0; j < static_cast<std::size_t>(bases.components[k]); ++j)
            store_weight(&receivers.weights[p * stride + j * size], weights[p * most + j],
                         static_cast<double>(bases.scales[first[k] - k + j]), format);
    }
    return result;
}

} // namespace prt

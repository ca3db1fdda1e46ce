// Compression options: presets, defaults by format, and validation.

#include "compress/pipeline/compress_options.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace prt {
namespace {

[[noreturn]] void out_of_range(const std::string& what, double value) {
    std::ostringstream message;
    message.precision(12);
    message << what << ", not " << value;
    throw Error(message.str());
}

void check_packed(const WeightCoding& coding, int clusters) {
    if (coding.fixed_bits.empty() && (coding.bits < 0 || coding.bits > kMaxPackedBits))
        out_of_range("the number of weight bits per vertex must be in 0.." + std::to_string(kMaxPackedBits),
                     coding.bits);
    for (const int bits : coding.fixed_bits)
        if (bits < 1 || bits > kMaxWeightBits)
            out_of_range("the number of bits per weight must be in 1.." + std::to_string(kMaxWeightBits),
                         bits);
    if (coding.cluster_bits < 0 || coding.cluster_bits > 16 ||
        (coding.cluster_bits > 0 && clusters > 1 << coding.cluster_bits))
        throw Error(std::to_string(clusters) + " clusters do not fit into " +
                    counted(coding.cluster_bits, "bit"));
}

void check_options(const CompressOptions& o) {
    if (o.clusters < 1 || o.clusters > 65536)
        out_of_range("the number of clusters must be in 1..65536", o.clusters);
    if (o.coding.components < 0)
        out_of_range("the number of components must not be negative", o.coding.components);
    if (!(o.mean_components >= 0 && std::isfinite(o.mean_components)))
        out_of_range("the number of components per vertex must be finite and not negative",
                     o.mean_components);
    if (o.coding.format == WeightFormat::packed)
        check_packed(o.coding, o.clusters);
    if (!(o.seam_weight >= 0 && o.seam_weight <= kMaxSeamWeight))
        out_of_range("the seam weight must be in 0..1e6", o.seam_weight);
    if (o.basis_share && !(*o.basis_share >= 0 && *o.basis_share < 1))
        out_of_range("the share of the bases must be at least 0 and less than 1", *o.basis_share);
}

/// Checks a receiver attribute; empty if the renderer does not have it.
void check_attribute(std::span<const glm::vec3> values, std::size_t receivers, const char* name) {
    if (!values.empty() && values.size() != receivers)
        throw Error("there are " + std::to_string(receivers) + " receivers, but " + std::string(name) +
                    " for " + std::to_string(values.size()));
    for (const glm::vec3& v : values)
        if (!(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)))
            throw Error("the " + std::string(name) + " of receivers are not finite");
}

void check_finite(const TransferView& transfer, std::span<const float> areas) {
    constexpr std::size_t kRead = 256;
    std::vector<float> vectors;
    for (std::size_t begin = 0; begin < transfer.receivers(); begin += kRead) {
        vectors.resize(std::min(kRead, transfer.receivers() - begin) * transfer.dimension());
        transfer.read(begin, vectors);
        if (!std::ranges::all_of(vectors, [](float v) { return std::abs(v) <= kMaxInputTransfer; }))
            throw Error("the transfer contains values that are not finite or exceed 1e12");
    }
    if (!std::all_of(areas.begin(), areas.end(), [](float area) { return std::isfinite(area); }))
        throw Error("the areas of receivers are not finite");
}

} // namespace

WeightCoding preset_u32() {
    return {.bits = 24, .cluster_bits = 8};
}

WeightCoding preset_u64() {
    return {.bits = 56, .cluster_bits = 8};
}

WeightCoding preset_u32x4() {
    return {.components = 4, .fixed_bits = {7, 6, 6, 5}, .cluster_bits = 8};
}

WeightCoding preset_u64x9() {
    return {.components = 9, .fixed_bits = {9, 8, 7, 7, 6, 6, 5, 4, 4}, .cluster_bits = 8};
}

void check_input(const TransferView& transfer, const ReceiverSurface& surface,
                 const CompressOptions& options) {
    check_layout(transfer.layout());
    check_options(options);
    const std::optional<LightMetric>& metric = options.metric;
    if (metric && metric->layout != transfer.layout())
        throw Error("the metric and the transfer have different orders or terms");
    if (transfer.receivers() == 0)
        throw Error("the transfer has no receivers");
    if (surface.areas.size() != transfer.receivers())
        throw Error("there are " + std::to_string(transfer.receivers()) + " receivers, but areas for " +
                    std::to_string(surface.areas.size()));
    check_finite(transfer, surface.areas);
    check_attribute(surface.normals, transfer.receivers(), "normals");
    check_attribute(surface.positions, transfer.receivers(), "positions");
    for (const Edge& edge : surface.edges)
        if (edge.first >= transfer.receivers() || edge.second >= transfer.receivers())
            throw Error("an edge connects receivers " + std::to_string(edge.first) + " and " +
                        std::to_string(edge.second) + ", but there are only " +
                        std::to_string(transfer.receivers()));
    for (const SeamJump& jump : surface.jumps)
        for (const std::uint32_t receiver : jump.receivers)
            if (receiver >= transfer.receivers())
                throw Error("a seam refers to receiver " + std::to_string(receiver) +
                            ", but there are only " + std::to_string(transfer.receivers()));
}

LightMetric metric_of(const CompressOptions& options, const TransferView& transfer,
                      std::span<const float> areas) {
    return options.metric ? *options.metric
                          : balanced(metric_of_family(LightFamily::outdoor, transfer.layout()), transfer,
                                     areas, options.threads);
}

double basis_share(const CompressOptions& options) {
    return options.coding.format == WeightFormat::packed ? options.basis_share.value_or(tuning::kBasisShare)
                                                         : 0;
}

bool bases_are_coded(const CompressOptions& options) {
    return basis_share(options) > 0;
}

ClusteringOptions clustering_options(const CompressOptions& options, std::size_t dimension) {
    const WeightCoding& coding = options.coding;
    ClusteringOptions how;
    how.clusters = static_cast<std::size_t>(options.clusters);
    how.mean_components = options.mean_components;
    how.trace = options.trace;
    how.threads = options.threads;
    how.rate_budget.component_limit = std::min(coding.components, static_cast<int>(dimension));
    if (coding.format != WeightFormat::packed)
        return how;
    how.rows_cost = options.bases_count;
    int most = kMaxPackedComponents;
    if (!coding.fixed_bits.empty())
        most = std::min(most, static_cast<int>(coding.fixed_bits.size()));
    else if (coding.bits == 0)
        most = 0;
    how.rate_budget.component_limit = std::min(how.rate_budget.component_limit, most);
    how.rate_budget.bits = coding.bits;
    how.rate_budget.fixed_bits = coding.fixed_bits;
    return how;
}

} // namespace prt

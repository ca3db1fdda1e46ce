// Reads clusters, bases and packed weights: docs/format.md.

#include "runtime/load/clustered_set.h"

#include "runtime/core/support/bits.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/predictors_json.h"
#include "runtime/load/transfer_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace prt {
namespace {

/// Throws if the rows, the rows for constants, and the code that they are decoded from would need too much
/// memory: a row of zeros takes four bits, and none without axes.
void check_rows(const GltfData& data, std::size_t rows, std::size_t axes, std::size_t dimension) {
    const auto values = static_cast<double>(rows) * static_cast<double>(axes + 3 * dimension) +
                        static_cast<double>(axes) * static_cast<double>(dimension);
    check_allowed(values * sizeof(float), data.file_bytes, "its bases");
}

/// Reads the step of all axes, or the steps of groups of axes in each cluster.
void read_steps(const GltfData& data, const Json& json, CodedBases& coded) {
    const bool many = json.contains("steps");
    const Json& step = many ? json["steps"].at("least") : json.at("step");
    coded.step = step.is_number() ? step.get<float>() : -1.0f;
    if (!(coded.step >= 0) || !std::isfinite(coded.step))
        throw Error("the step of the bases is " + step.dump() +
                    ", but must be a finite number of at least 0");
    if (!many)
        return;
    if (json.contains("step"))
        throw Error("the bases have both \"step\" and \"steps\"");
    coded.exponents.code = read_row_code(data, json["steps"]);
    for (const Json& axes : json["steps"].at("axes"))
        coded.exponents.axes.push_back(whole_number(axes, "the number of axes", 0, 1 << 16));
    if (coded.exponents.empty())
        throw Error("the list \"axes\" in \"steps\" of the bases is empty");
}

/// Reads the rows of `bases`, whose components and predictors are known.
void read_bases(const GltfData& data, const Json& json, ClusteredBases& bases) {
    const std::size_t rows = bases.first_rows().back(), dimension = bases.dimension();
    if (!json.contains("values")) {
        bases.rows = read_float_view(data, json, rows * dimension, kMaxTransfer, "the bases");
        return;
    }
    constexpr float kAnyFinite = std::numeric_limits<float>::max(); // small steps may have large scales
    CodedBases& coded = bases.coded;
    coded.origin = read_float_view(data, json.at("origin"), dimension, kMaxTransfer, "the origin");
    if (json.contains("units"))
        coded.units = read_float_view(data, json["units"], dimension, kAnyFinite, "the units");
    coded.axes = read_row_code(data, json.at("axes"));
    coded.values = read_row_code(data, json.at("values"));
    const std::size_t axes = coded.values.drops.size();
    coded.scales = read_float_view(data, json.at("scales"), axes, kAnyFinite, "the scales");
    read_steps(data, json, coded);
    check_rows(data, rows, axes, dimension);
    bases.rows = decode_bases(coded, bases.components, bases.predictor_rows());
    check_magnitudes(bases.rows, kMaxTransfer, "the decoded bases");
}

/// Reads the bit widths of weights, and computes the number of words per receiver.
void read_packing(const GltfData& data, const Json& json, ClusteredTransfer& transfer) {
    ClusteredBases& bases = transfer.bases;
    ClusteredReceivers& receivers = transfer.receivers;
    receivers.format = WeightFormat::packed;
    receivers.cluster_bits = whole_number(json.at("clusterBits"), "clusterBits", 0, 16);
    if (bases.clusters() > std::size_t{1} << receivers.cluster_bits)
        throw Error(std::to_string(bases.clusters()) + " clusters do not fit into " +
                    std::to_string(receivers.cluster_bits) + " bits");
    BitReader reader(buffer_view_bytes(data.model, json.at("bufferView").get<int>()));
    const std::size_t directions = bases.first_rows().back() - bases.clusters() * bases.fixed_rows();
    std::size_t most = 0;
    for (const int components : bases.components) {
        if (components > kMaxPackedComponents)
            throw Error("a cluster has " + std::to_string(components) +
                        " packed components, but must have 0.." + std::to_string(kMaxPackedComponents));
        auto total = static_cast<std::size_t>(receivers.cluster_bits);
        for (int j = 0; j < components; ++j) {
            if (!reader.has(4))
                throw Error("the bit counts end before the last of " + std::to_string(directions) +
                            " packed components");
            bases.bits.push_back(static_cast<std::uint8_t>(reader.read(4) + 1));
            total += bases.bits.back();
        }
        most = std::max(most, total);
    }
    receivers.words = std::max(1, static_cast<int>((most + 31) / 32));
}

/// Reads order, terms and components.
ClusteredBases read_components(const Json& set, std::size_t outputs) {
    ClusteredBases bases;
    bases.layout = read_layout(set);
    bases.layout.outputs = outputs;
    const int most = static_cast<int>(bases.dimension());
    for (const Json& count : set.at("components"))
        bases.components.push_back(whole_number(count, "the number of a cluster's components", 0, most));
    if (bases.components.empty() || bases.components.size() > 65536)
        throw Error("has " + std::to_string(bases.components.size()) + " clusters, but must have 1..65536");
    return bases;
}

} // namespace

ClusteredTransfer read_clusters(const GltfData& data, const Json& set, std::size_t outputs) {
    ClusteredTransfer transfer;
    transfer.bases = read_components(set, outputs);
    if (set.contains("packing"))
        read_packing(data, set["packing"], transfer);
    else
        transfer.receivers.components = (transfer.bases.max_components() + 3) / 4 * 4;
    return transfer;
}

CompressedTransfer read_clustered_set(const GltfData& data, const Scene& scene, const Json& set,
                                      std::size_t outputs) {
    CompressedTransfer compressed{read_clusters(data, set, outputs),
                                  read_record(set.value("bake", Json::object()))};
    ClusteredBases& bases = compressed.transfer.bases;
    read_predictors(data, scene, set, bases);
    read_bases(data, set.at("bases"), bases);
    return compressed;
}

} // namespace prt

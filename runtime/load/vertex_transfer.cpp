// Reads compressed transfer of vertices: docs/format.md.
#include "runtime/load/vertex_transfer.h"

#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/changed_file.h"
#include "runtime/load/clustered_set.h"
#include "runtime/load/coded_vertices.h"
#include "runtime/load/fallback.h"
#include "runtime/load/own_attributes.h"
#include "runtime/load/receiver_sets.h"
#include "runtime/load/transfer_json.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string>

namespace prt {
namespace {

/// Throws unless weights of `format` are stored as they were written.
void check_weight_accessor(const std::string& name, const GltfAccessor& accessor, WeightFormat format,
                           std::size_t vertices) {
    if (accessor.componentType != weight_type(format))
        throw Error(name + " has component type " + std::to_string(accessor.componentType) + ", not " +
                    std::to_string(weight_type(format)) + kCompressAgain);
    if (accessor.normalized)
        throw Error(name + " is normalized, but must not be" + kCompressAgain);
    if (accessor.components != 4 || accessor.count != vertices)
        throw Error(name + " is not one VEC4 per vertex" + kCompressAgain);
}

/// Returns the accessor of an attribute. Throws `Error` if it is missing.
int accessor_of(const Json& attributes, const std::string& name) {
    if (!attributes.contains(name))
        throw Error("has no attribute " + name + kCompressAgain);
    return attributes.at(name).get<int>();
}

/// Throws `Error` if the file has attributes of transfer but no extension of prtkit. Programs that copy only
/// the extensions that they support write such files.
void check_extension_is_kept(const GltfData& data) {
    if (const auto extensions = data.json.find("extensions"); extensions != data.json.end())
        for (auto it = extensions->begin(); it != extensions->end(); ++it)
            if (it.key().starts_with("PRTKIT_"))
                return;
    for_each_primitive(data.json, [](const Json& primitive) {
        const Json& attributes = primitive.value("attributes", Json::object());
        for (auto it = attributes.begin(); it != attributes.end(); ++it)
            if (it.key().starts_with("_PRT_WEIGHTS_") || it.key() == "_PRT_CLUSTER")
                throw Error("has attribute " + it.key() + ", but not the extension " + kTransferExtension +
                            kCompressAgain);
    });
}

/// Reads the cluster indices of one vertex array.
void read_clusters(const GltfData& data, const Json& attributes, std::size_t clusters,
                   std::span<std::uint16_t> to) {
    const auto values = read_unsigned(data.model, accessor_of(attributes, "_PRT_CLUSTER"), 1);
    if (values.size() != to.size())
        throw Error("_PRT_CLUSTER has " + std::to_string(values.size()) + " elements, but there are " +
                    std::to_string(to.size()) + " vertices");
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] >= clusters)
            throw Error("vertex " + std::to_string(i) + " has cluster " + std::to_string(values[i]) +
                        ", but there are only " + std::to_string(clusters));
        to[i] = static_cast<std::uint16_t>(values[i]);
    }
}

/// Reads the weights of one vertex array, into receivers starting at `first`.
void read_weights(const GltfData& data, const Json& attributes, std::size_t first, std::size_t count,
                  ClusteredReceivers& receivers) {
    const std::size_t size = group_bytes(receivers.format), stride = receivers.stride();
    for (std::size_t group = 0; group < group_count(receivers); ++group) {
        const std::string name = weights_name(group);
        const int accessor = accessor_of(attributes, name);
        check_weight_accessor(name, data.model.accessors.at(static_cast<std::size_t>(accessor)),
                              receivers.format, count);
        const std::vector<std::byte> elements = read_elements(data.model, accessor);
        if (receivers.format == WeightFormat::float32)
            check_magnitudes(read_floats(data.model, accessor, 4), kMaxFloatWeight, "the weights");
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(&receivers.weights[(first + i) * stride + group * size], &elements[i * size], size);
    }
}

/// Allocates the weights of `count` receivers.
void make_room(const GltfData& data, std::size_t count, ClusteredReceivers& receivers) {
    check_allowed(static_cast<double>(count) * static_cast<double>(receivers.stride()), data.file_bytes,
                  "its weights");
    receivers.weights.resize(count * receivers.stride());
}

/// Returns the transfer attributes of prtkit in `attributes`, sorted by name.
Json own_attributes(const Json& attributes) {
    std::map<std::string, Json> own;
    for (auto it = attributes.begin(); it != attributes.end(); ++it)
        if (is_own_attribute(it.key()) && it.key() != kOtherColors)
            own[it.key()] = *it;
    return own;
}

/// Reads clusters and weights of one primitive. `count`: number of receivers of all primitives.
void read_receivers(const GltfData& data, const Json& attributes, const VertexArray& vertices,
                    std::size_t count, ClusteredTransfer& transfer) {
    ClusteredReceivers& receivers = transfer.receivers;
    const std::size_t clusters = transfer.bases.clusters();
    const bool packed = receivers.words > 0;
    if (!packed)
        read_clusters(data, attributes, clusters,
                      std::span(receivers.clusters).subspan(vertices.first_receiver, vertices.size()));
    if (receivers.weights.empty())
        make_room(data, count, receivers);
    read_weights(data, attributes, vertices.first_receiver, vertices.size(), receivers);
    if (packed)
        check_clusters(clusters, vertices.first_receiver, vertices.size(), "vertex", receivers);
}

} // namespace

int weight_type(WeightFormat format) {
    return format == WeightFormat::packed ? kUnsignedByte : kFloat;
}

std::size_t group_bytes(WeightFormat format) {
    return format == WeightFormat::packed ? 4 : 4 * sizeof(float);
}

std::size_t group_count(const ClusteredReceivers& receivers) {
    return receivers.stride() / group_bytes(receivers.format);
}

std::optional<CompressedTransfer> read_clustered(const GltfData& data, const Scene& scene) {
    const Json* set = find_set(data, ReceiverKind::vertices, Coding::clustered);
    if (!set) {
        check_extension_is_kept(data);
        return std::nullopt;
    }
    check_one_to_one(data);
    if (scene.receivers() > 0 && std::ranges::all_of(scene.vertex_arrays, &VertexArray::lobes))
        throw Error("has transfer of vertices, although all of its vertices have lobes");
    CompressedTransfer compressed = read_clustered_set(data, scene, *set);
    ClusteredReceivers& receivers = compressed.transfer.receivers;
    if (receivers.words == 0)
        receivers.clusters.resize(scene.receivers());
    check_predictors(scene, compressed.transfer.bases.predictors);
    TransferOfVertices read;
    for (const Primitive& primitive : scene.primitives) {
        const Json& attributes = primitive_json(data, primitive).at("attributes");
        if (scene.vertex_arrays[primitive.vertices].lobes ||
            !read.is_new(primitive, own_attributes(attributes)))
            continue;
        try {
            read_receivers(data, attributes, scene.vertex_arrays[primitive.vertices], scene.receivers(),
                           compressed.transfer);
        } catch (const std::exception& error) {
            throw Error(primitive_name(primitive) + ": " + in_plain_words(error));
        }
    }
    return compressed;
}

} // namespace prt

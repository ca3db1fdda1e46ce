// Compressed transfer in glTF files: PRTKIT_clustered_pca of docs/format.md.

#include "prt/gltf.h"

#include "gltf/accessor.h"
#include "gltf/allowance.h"
#include "gltf/guides_json.h"
#include "gltf/own_attributes.h"
#include "gltf/transfer_json.h"
#include "gltf/unshare.h"
#include "prt/support/bits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>

namespace prt {
namespace {

constexpr int kClusteredVersion = 6;

int weight_component_type(WeightFormat format) {
    switch (format) {
    case WeightFormat::packed:
        return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    case WeightFormat::snorm8:
        return TINYGLTF_COMPONENT_TYPE_BYTE;
    case WeightFormat::snorm16:
        return TINYGLTF_COMPONENT_TYPE_SHORT;
    case WeightFormat::float32:
        break;
    }
    return TINYGLTF_COMPONENT_TYPE_FLOAT;
}

WeightFormat weight_format(int component_type) {
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return WeightFormat::packed;
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return WeightFormat::snorm8;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return WeightFormat::snorm16;
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return WeightFormat::float32;
    default:
        throw Error("weights have component type " + std::to_string(component_type));
    }
}

/// _PRT_CLUSTER: one or two bytes per vertex, aligned to four as glTF wants it.
std::size_t write_clusters(GltfContents& contents, std::span<const std::uint16_t> clusters, bool wide) {
    std::vector<std::byte> bytes(clusters.size() * 4);
    for (std::size_t i = 0; i < clusters.size(); ++i)
        std::memcpy(&bytes[i * 4], &clusters[i], wide ? 2 : 1); // little-endian, as glTF is
    return contents.add_accessor({{"bufferView", contents.add_buffer_view(bytes, 4, true)},
                                  {"componentType", wide ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
                                                         : TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE},
                                  {"count", clusters.size()},
                                  {"type", "SCALAR"}});
}

/// Bytes of one _PRT_WEIGHTS_ attribute: four weights, or a word of packed ones.
std::size_t group_bytes(WeightFormat format) {
    return format == WeightFormat::packed ? 4 : 4 * bytes_per_weight(format);
}

std::size_t group_count(const ClusteredReceivers& receivers) {
    return receivers.stride() / group_bytes(receivers.format);
}

/// _PRT_WEIGHTS_`group` of receivers [first, first + count).
std::size_t write_weights(GltfContents& contents, const ClusteredReceivers& receivers, std::size_t first,
                          std::size_t count, std::size_t group) {
    const std::size_t size = group_bytes(receivers.format), stride = receivers.stride();
    std::vector<std::byte> bytes(count * size);
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(&bytes[i * size], &receivers.weights[(first + i) * stride + group * size], size);
    Json accessor = {{"bufferView", contents.add_buffer_view(bytes, size, true)},
                     {"componentType", weight_component_type(receivers.format)},
                     {"count", count},
                     {"type", "VEC4"}};
    if (receivers.format == WeightFormat::snorm8 || receivers.format == WeightFormat::snorm16)
        accessor["normalized"] = true;
    return contents.add_accessor(std::move(accessor));
}

/// Cluster indices of one vertex array.
void read_clusters(const GltfContents& contents, const Json& attributes, std::size_t clusters,
                   std::span<std::uint16_t> to) {
    const auto values = read_unsigned(contents.model, attributes.at("_PRT_CLUSTER").get<int>(), 1);
    if (values.size() != to.size())
        throw Error("_PRT_CLUSTER has " + std::to_string(values.size()) + " elements for " +
                    std::to_string(to.size()) + " vertices");
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] >= clusters)
            throw Error("vertex " + std::to_string(i) + " is in cluster " + std::to_string(values[i]) +
                        " of " + std::to_string(clusters));
        to[i] = static_cast<std::uint16_t>(values[i]);
    }
}

/// Weights of one vertex array, into receivers from `first` on.
void read_weights(const GltfContents& contents, const Json& attributes, std::size_t first, std::size_t count,
                  ClusteredReceivers& receivers) {
    const std::size_t size = group_bytes(receivers.format), stride = receivers.stride();
    for (std::size_t group = 0; group < group_count(receivers); ++group) {
        const std::string name = "_PRT_WEIGHTS_" + std::to_string(group);
        const int accessor = attributes.at(name).get<int>();
        const auto& description = contents.model.accessors.at(static_cast<std::size_t>(accessor));
        if (description.type != TINYGLTF_TYPE_VEC4 || description.count != count ||
            weight_format(description.componentType) != receivers.format)
            throw Error(name + " has another type or number than the others");
        const std::vector<std::byte> elements = read_elements(contents.model, accessor);
        if (receivers.format == WeightFormat::float32)
            check_magnitudes(read_floats(contents.model, accessor, 4), kLargestWeight, "the weights");
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(&receivers.weights[(first + i) * stride + group * size], &elements[i * size], size);
    }
}

/// The clusters of receivers [first, first + count), out of their words.
void unpack_clusters(std::size_t first, std::size_t count, std::size_t clusters,
                     ClusteredReceivers& receivers) {
    for (std::size_t p = first; p < first + count; ++p) {
        std::uint32_t word = 0;
        std::memcpy(&word, &receivers.weights[p * receivers.stride()], sizeof word);
        const std::uint32_t k = word & ((1u << receivers.cluster_bits) - 1);
        if (k >= clusters)
            throw Error("vertex " + std::to_string(p - first) + " is in cluster " + std::to_string(k) +
                        " of " + std::to_string(clusters));
        receivers.clusters[p] = static_cast<std::uint16_t>(k);
    }
}

Json write_bases(GltfContents& contents, const ClusteredBases& bases) {
    if (!bases.is_coded())
        return write_float_view(contents, bases.rows);
    const CodedBases& coded = bases.coded;
    Json json = {{"origin", write_float_view(contents, coded.origin)},
                 {"scales", write_float_view(contents, coded.scales)},
                 {"step", coded.step},
                 {"axes", write_row_code(contents, coded.axes)},
                 {"values", write_row_code(contents, coded.values)}};
    if (!coded.units.empty())
        json["units"] = write_float_view(contents, coded.units);
    return json;
}

/// Throws where the rows, those that constants are formed from, and what they are decoded from would take too
/// much memory: a row of zeros has four bits, and none where there are no axes.
void check_rows(const GltfContents& contents, std::size_t rows, std::size_t axes, std::size_t dimension) {
    const auto values = static_cast<double>(rows) * static_cast<double>(axes + 3 * dimension) +
                        static_cast<double>(axes) * static_cast<double>(dimension);
    check_allowed(values * sizeof(float), contents.file_bytes, "its bases");
}

void read_bases(const GltfContents& contents, const Json& json, ClusteredBases& bases) {
    const std::size_t rows = bases.first_rows().back(), dimension = bases.dimension();
    if (!json.contains("values")) {
        bases.rows = read_float_view(contents, json, rows * dimension, kLargestTransfer, "the bases");
        return;
    }
    constexpr float kAnyFinite = std::numeric_limits<float>::max(); // small steps may have large scales
    CodedBases& coded = bases.coded;
    coded.origin = read_float_view(contents, json.at("origin"), dimension, kLargestTransfer, "the origin");
    if (json.contains("units"))
        coded.units = read_float_view(contents, json["units"], dimension, kAnyFinite, "the units");
    coded.axes = read_row_code(contents, json.at("axes"));
    coded.values = read_row_code(contents, json.at("values"));
    const std::size_t axes = coded.values.drops.size();
    coded.scales = read_float_view(contents, json.at("scales"), axes, kAnyFinite, "the scales");
    const Json& step = json.at("step");
    coded.step = step.is_number() ? step.get<float>() : -1.0f;
    if (!(coded.step >= 0) || !std::isfinite(coded.step))
        throw Error("the step of the bases is " + step.dump() + ", no number from 0 on");
    check_rows(contents, rows, axes, dimension);
    bases.rows = decode_bases(coded, bases.components, bases.guide_rows());
    check_magnitudes(bases.rows, kLargestTransfer, "the decoded bases");
}

Json write_packing(GltfContents& contents, const ClusteredTransfer& transfer) {
    BitWriter writer;
    for (const std::uint8_t bits : transfer.bases.bits)
        writer.write(bits - 1u, 4);
    return {{"clusterBits", transfer.receivers.cluster_bits},
            {"bufferView", contents.add_buffer_view(writer.take())}};
}

void read_packing(const GltfContents& contents, const Json& json, ClusteredTransfer& transfer) {
    ClusteredBases& bases = transfer.bases;
    ClusteredReceivers& receivers = transfer.receivers;
    receivers.format = WeightFormat::packed;
    receivers.cluster_bits = whole_number(json.at("clusterBits"), "clusterBits", 0, 16);
    if (bases.clusters() > std::size_t{1} << receivers.cluster_bits)
        throw Error(std::to_string(bases.clusters()) + " clusters do not fit " +
                    std::to_string(receivers.cluster_bits) + " bits");
    BitReader reader(std::as_bytes(buffer_view_bytes(contents.model, json.at("bufferView").get<int>())));
    const std::size_t directions = bases.first_rows().back() - bases.clusters() * bases.fixed_rows();
    std::size_t most = 0;
    for (const int components : bases.components) {
        if (components > kMostPackedComponents)
            throw Error("a cluster has " + std::to_string(components) + " packed components, of 0.." +
                        std::to_string(kMostPackedComponents));
        auto total = static_cast<std::size_t>(receivers.cluster_bits);
        for (int j = 0; j < components; ++j) {
            if (!reader.has(4))
                throw Error("there are no bits for " + std::to_string(directions) + " packed components");
            bases.bits.push_back(static_cast<std::uint8_t>(reader.read(4) + 1));
            total += bases.bits.back();
        }
        most = std::max(most, total);
    }
    receivers.words = std::max(1, static_cast<int>((most + 31) / 32));
}

ClusteredBases read_clusters_of(const Json& extension) {
    ClusteredBases bases;
    bases.layout = read_layout(extension);
    const int most = static_cast<int>(bases.dimension());
    for (const Json& count : extension.at("components"))
        bases.components.push_back(whole_number(count, "the number of a cluster's components", 0, most));
    if (bases.components.empty() || bases.components.size() > 65536)
        throw Error("has " + std::to_string(bases.components.size()) + " clusters, of 1..65536");
    return bases;
}

void write_into(GltfContents& contents, const Scene& scene, const CompressedTransfer& compressed) {
    const std::vector<Json*> primitives = unshare(contents, scene);
    contents.remove_transfer();
    const ClusteredBases& bases = compressed.transfer.bases;
    const ClusteredReceivers& receivers = compressed.transfer.receivers;
    std::vector<Json> attributes;
    for (const VertexArray& vertices : scene.vertex_arrays) {
        Json added = Json::object();
        if (receivers.format != WeightFormat::packed)
            added["_PRT_CLUSTER"] = write_clusters(
                contents, std::span(receivers.clusters).subspan(vertices.first_receiver, vertices.size()),
                bases.clusters() > 256);
        for (std::size_t group = 0; group < group_count(receivers); ++group)
            added["_PRT_WEIGHTS_" + std::to_string(group)] =
                write_weights(contents, receivers, vertices.first_receiver, vertices.size(), group);
        attributes.push_back(std::move(added));
    }
    for (std::size_t i = 0; i < primitives.size(); ++i)
        (*primitives[i])["attributes"].update(attributes[scene.primitives[i].vertices]);
    Json& extension =
        extensions_of(contents.json)[kClusteredExtension] = {{"version", kClusteredVersion},
                                                             {"order", bases.layout.order},
                                                             {"parts", parts_json(bases.layout)},
                                                             {"components", bases.components}};
    write_guides(contents, scene, bases, extension);
    extension["bases"] = write_bases(contents, bases);
    if (receivers.format == WeightFormat::packed)
        extension["packing"] = write_packing(contents, compressed.transfer);
    extension["bake"] = record_json(compressed.record);
    contents.use_extension(kClusteredExtension);
}

/// Room for the weights of all receivers, whose `attributes` name the first.
void make_room(const GltfContents& contents, const Json& attributes, ClusteredReceivers& receivers) {
    const bool packed = receivers.format == WeightFormat::packed;
    if (!packed && receivers.components > 0) {
        const auto first = attributes.at("_PRT_WEIGHTS_0").get<int>();
        receivers.format = weight_format(get_accessor(contents.model, first).componentType);
        if (receivers.format == WeightFormat::packed)
            throw Error("_PRT_WEIGHTS_0 is packed, but the file does not say how");
    }
    check_allowed(static_cast<double>(receivers.size()) * static_cast<double>(receivers.stride()),
                  contents.file_bytes, "its weights");
    receivers.weights.resize(receivers.size() * receivers.stride());
}

/// Those of `attributes` that are ours, in the order of their names.
Json own_attributes(const Json& attributes) {
    std::map<std::string, Json> own;
    for (auto it = attributes.begin(); it != attributes.end(); ++it)
        if (is_own_attribute(it.key()))
            own[it.key()] = *it;
    return own;
}

/// Clusters and weights of one primitive.
void read_receivers(const GltfContents& contents, const Json& attributes, const VertexArray& vertices,
                    ClusteredTransfer& transfer) {
    ClusteredReceivers& receivers = transfer.receivers;
    const std::size_t clusters = transfer.bases.clusters();
    const bool packed = receivers.words > 0;
    if (!packed)
        read_clusters(contents, attributes, clusters,
                      std::span(receivers.clusters).subspan(vertices.first_receiver, vertices.size()));
    if (receivers.weights.empty())
        make_room(contents, attributes, receivers);
    read_weights(contents, attributes, vertices.first_receiver, vertices.size(), receivers);
    if (packed)
        unpack_clusters(vertices.first_receiver, vertices.size(), clusters, receivers);
}

} // namespace

void write_clustered(GltfDocument& document, const Scene& scene, const CompressedTransfer& compressed) {
    named(document, [&](GltfContents& contents) { write_into(contents, scene, compressed); });
}

std::optional<CompressedTransfer> read_clustered(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<CompressedTransfer> {
        const Json* extension = find_extension(contents, kClusteredExtension, kClusteredVersion);
        if (!extension)
            return std::nullopt;
        CompressedTransfer compressed;
        ClusteredBases& bases = compressed.transfer.bases;
        ClusteredReceivers& receivers = compressed.transfer.receivers;
        bases = read_clusters_of(*extension);
        compressed.record = read_record(extension->value("bake", Json::object()));
        read_guides(contents, scene, *extension, bases);
        read_bases(contents, extension->at("bases"), bases);
        const bool packed = extension->contains("packing");
        if (packed)
            read_packing(contents, extension->at("packing"), compressed.transfer);
        else
            receivers.components = (bases.max_components() + 3) / 4 * 4;
        receivers.clusters.resize(scene.receivers());
        receivers.guides = read_coordinates(contents, scene, bases);
        TransferOfVertices read;
        for (const Primitive& primitive : scene.primitives) {
            const Json& attributes = primitive_json(contents, primitive).at("attributes");
            if (!read.is_new(primitive, own_attributes(attributes)))
                continue;
            try {
                read_receivers(contents, attributes, scene.vertex_arrays[primitive.vertices],
                               compressed.transfer);
            } catch (const std::exception& error) {
                throw Error(primitive_name(primitive) + ": " + in_plain_words(error));
            }
        }
        return compressed;
    });
}

} // namespace prt

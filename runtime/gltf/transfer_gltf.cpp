// Transfer in glTF files. The format is specified in docs/format.md.

#include "prt/gltf.h"

#include "accessor.h"
#include "contents.h"
#include "prt/error.h"
#include "prt/sh.h"
#include "unshare.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace prt {
namespace {

constexpr int kVersion = 1;

Json record_json(const BakeRecord& record) {
    return {{"method", record.method},
            {"backend", record.backend},
            {"raysPerReceiver", record.rays},
            {"bounces", record.bounces},
            {"seed", record.seed},
            {"receivers", record.receivers},
            {"samplingError", record.sampling_error}};
}

BakeRecord read_record(const Json& json) {
    BakeRecord record;
    record.method = json.value("method", "");
    record.backend = json.value("backend", "");
    record.rays = json.value("raysPerReceiver", 0);
    record.bounces = json.value("bounces", 0);
    record.seed = json.value("seed", std::uint64_t{0});
    record.receivers = json.value("receivers", "");
    record.sampling_error = json.value("samplingError", 0.0);
    return record;
}

/// The extension `name` at the top level, nothing when the file does not have it.
const Json* find_extension(const GltfContents& contents, const char* name) {
    if (!contents.json.contains("extensions") || !contents.json["extensions"].contains(name))
        return nullptr;
    const Json& extension = contents.json["extensions"][name];
    const int version = extension.value("version", 0);
    if (version != kVersion)
        throw Error(std::string(name) + " has version " + std::to_string(version) + ", this program reads " +
                    std::to_string(kVersion));
    return &extension;
}

void read_shape(const Json& extension, int& order, int& channels) {
    order = extension.at("order").get<int>();
    check_order(order);
    channels = extension.at("channels").get<int>();
    if (channels != 1 && channels != 3)
        throw Error("has " + std::to_string(channels) + " channels, only 1 or 3 make sense");
}

/// JSON of a scene primitive, in a file that holds the scene one to one.
const Json& primitive_json(const GltfContents& contents, const Primitive& primitive) {
    return contents.json.at("meshes")
        .at(static_cast<std::size_t>(primitive.mesh))
        .at("primitives")
        .at(static_cast<std::size_t>(primitive.primitive));
}

std::string primitive_name(const Primitive& primitive) {
    return "mesh " + std::to_string(primitive.mesh) + " primitive " + std::to_string(primitive.primitive);
}

/// GL_HALF_FLOAT. glTF's accessors do not know it, but the views of our extensions are no accessors.
constexpr int kHalfComponentType = 5131;

bool is_half(const Json& object) {
    return object.value("componentType", TINYGLTF_COMPONENT_TYPE_FLOAT) == kHalfComponentType;
}

/// Floats of {"bufferView": ..., "componentType": 5126 or 5131}; throws unless there are `count`, all finite.
std::vector<float> read_float_view(const GltfContents& contents, const Json& object, std::size_t count,
                                   const std::string& what) {
    const int type = object.value("componentType", TINYGLTF_COMPONENT_TYPE_FLOAT);
    if (type != TINYGLTF_COMPONENT_TYPE_FLOAT && type != kHalfComponentType)
        throw Error(what + " are of component type " + std::to_string(type) +
                    ", neither 5126 (float32) nor 5131 (float16)");
    const std::size_t size = is_half(object) ? sizeof(std::uint16_t) : sizeof(float);
    const auto bytes = buffer_view_bytes(contents.model, object.at("bufferView").get<int>());
    if (bytes.size() < count * size)
        throw Error(what + " need " + std::to_string(count * size) + " bytes, but there are " +
                    std::to_string(bytes.size()));
    std::vector<float> values(count);
    if (is_half(object)) {
        std::vector<std::uint16_t> halves(count);
        std::copy_n(bytes.data(), count * size, reinterpret_cast<unsigned char*>(halves.data()));
        std::transform(halves.begin(), halves.end(), values.begin(), glm::unpackHalf1x16);
    } else if (count > 0) {
        std::memcpy(values.data(), bytes.data(), count * size);
    }
    if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
        throw Error(what + " hold values that are not finite");
    return values;
}

Json write_float_view(GltfContents& contents, std::span<const float> values) {
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(values))},
            {"componentType", TINYGLTF_COMPONENT_TYPE_FLOAT}};
}

Json write_half_view(GltfContents& contents, std::span<const float> values) {
    std::vector<std::uint16_t> halves(values.size());
    std::transform(values.begin(), values.end(), halves.begin(), glm::packHalf1x16);
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(std::span(halves)))},
            {"componentType", kHalfComponentType}};
}

int weight_component_type(WeightFormat format) {
    switch (format) {
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

/// _PRT_WEIGHTS_`group` of receivers [first, first + count).
std::size_t write_weights(GltfContents& contents, const ClusteredReceivers& receivers, std::size_t first,
                          std::size_t count, std::size_t group) {
    const std::size_t size = 4 * bytes_per_weight(receivers.format);
    const std::size_t stride =
        static_cast<std::size_t>(receivers.components) * bytes_per_weight(receivers.format);
    std::vector<std::byte> bytes(count * size);
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(&bytes[i * size], &receivers.weights[(first + i) * stride + group * size], size);
    Json accessor = {{"bufferView", contents.add_buffer_view(bytes, size, true)},
                     {"componentType", weight_component_type(receivers.format)},
                     {"count", count},
                     {"type", "VEC4"}};
    if (receivers.format != WeightFormat::float32)
        accessor["normalized"] = true;
    return contents.add_accessor(std::move(accessor));
}

template <class Read>
auto named(const GltfDocument& document, Read&& read) {
    try {
        return read(document.contents());
    } catch (const std::exception& error) { // ours, and those of the JSON library on members of a wrong type
        throw Error(document.contents().path.string() + ": " + error.what());
    }
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
    const std::size_t size = 4 * bytes_per_weight(receivers.format);
    const std::size_t stride =
        static_cast<std::size_t>(receivers.components) * bytes_per_weight(receivers.format);
    for (std::size_t group = 0; group < static_cast<std::size_t>(receivers.components) / 4; ++group) {
        const int accessor = attributes.at("_PRT_WEIGHTS_" + std::to_string(group)).get<int>();
        const auto& description = contents.model.accessors.at(static_cast<std::size_t>(accessor));
        if (description.type != TINYGLTF_TYPE_VEC4 || description.count != count ||
            weight_format(description.componentType) != receivers.format)
            throw Error("_PRT_WEIGHTS_" + std::to_string(group) +
                        " has another type or number than the others");
        const std::vector<std::byte> elements = read_elements(contents.model, accessor);
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(&receivers.weights[(first + i) * stride + group * size], &elements[i * size], size);
    }
}

ClusteredBases read_bases(const GltfContents& contents, const Json& extension) {
    ClusteredBases bases;
    read_shape(extension, bases.order, bases.channels);
    std::size_t directions = 0;
    for (const Json& count : extension.at("components")) {
        const int components = count.get<int>();
        if (components < 0 || static_cast<std::size_t>(components) > bases.dimension())
            throw Error("a cluster has " + std::to_string(components) + " components, of 0.." +
                        std::to_string(bases.dimension()));
        bases.components.push_back(components);
        directions += static_cast<std::size_t>(components);
    }
    if (bases.components.empty() || bases.components.size() > 65536)
        throw Error("has " + std::to_string(bases.components.size()) + " clusters, of 1..65536");
    const std::size_t rows = bases.clusters() + directions;
    bases.rows = read_float_view(contents, extension.at("bases"), rows * bases.dimension(), "the bases");
    bases.scales = read_float_view(contents, extension.at("scales"), directions, "the scales");
    return bases;
}

} // namespace

void write_transfer(GltfDocument& document, const Scene& scene, const BakedTransfer& baked) {
    GltfContents& contents = document.contents();
    const std::vector<Json*> primitives = unshare(contents, scene);
    contents.remove_transfer();
    const Transfer& transfer = baked.transfer;
    std::vector<Json> views;
    const auto write = baked.storage == TransferStorage::float16 ? write_half_view : write_float_view;
    for (const VertexArray& vertices : scene.vertex_arrays)
        views.push_back(write(contents, std::span(transfer.vectors)
                                            .subspan(vertices.first_receiver * transfer.dimension(),
                                                     vertices.size() * transfer.dimension())));
    for (std::size_t i = 0; i < primitives.size(); ++i)
        (*primitives[i])["extensions"][kTransferExtension] = {
            {"vectors", views[scene.primitives[i].vertices]}};
    contents.json["extensions"][kTransferExtension] = {{"version", kVersion},
                                                       {"order", transfer.order},
                                                       {"channels", transfer.channels},
                                                       {"bake", record_json(baked.record)}};
    contents.use_extension(kTransferExtension);
}

std::optional<BakedTransfer> read_transfer(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<BakedTransfer> {
        const Json* extension = find_extension(contents, kTransferExtension);
        if (!extension)
            return std::nullopt;
        BakedTransfer baked;
        Transfer& transfer = baked.transfer;
        read_shape(*extension, transfer.order, transfer.channels);
        baked.record = read_record(extension->value("bake", Json::object()));
        transfer.vectors.resize(scene.receivers() * transfer.dimension());
        for (const Primitive& primitive : scene.primitives) {
            const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
            const Json& json = primitive_json(contents, primitive);
            if (!json.contains("extensions") || !json["extensions"].contains(kTransferExtension))
                throw Error(primitive_name(primitive) + " has no " + kTransferExtension);
            const Json& view = json["extensions"][kTransferExtension].at("vectors");
            if (is_half(view))
                baked.storage = TransferStorage::float16;
            const auto values = read_float_view(contents, view, vertices.size() * transfer.dimension(),
                                                "the vectors of " + primitive_name(primitive));
            std::copy(values.begin(), values.end(),
                      transfer.vectors.begin() +
                          static_cast<std::ptrdiff_t>(vertices.first_receiver * transfer.dimension()));
        }
        return baked;
    });
}

void write_clustered(GltfDocument& document, const Scene& scene, const CompressedTransfer& compressed) {
    GltfContents& contents = document.contents();
    const std::vector<Json*> primitives = unshare(contents, scene);
    contents.remove_transfer();
    const ClusteredBases& bases = compressed.transfer.bases;
    const ClusteredReceivers& receivers = compressed.transfer.receivers;
    std::vector<Json> attributes;
    for (const VertexArray& vertices : scene.vertex_arrays) {
        Json added = Json::object();
        added["_PRT_CLUSTER"] = write_clusters(
            contents, std::span(receivers.clusters).subspan(vertices.first_receiver, vertices.size()),
            bases.clusters() > 256);
        for (std::size_t group = 0; group < static_cast<std::size_t>(receivers.components) / 4; ++group)
            added["_PRT_WEIGHTS_" + std::to_string(group)] =
                write_weights(contents, receivers, vertices.first_receiver, vertices.size(), group);
        attributes.push_back(std::move(added));
    }
    for (std::size_t i = 0; i < primitives.size(); ++i)
        (*primitives[i])["attributes"].update(attributes[scene.primitives[i].vertices]);
    contents.json["extensions"][kClusteredExtension] = {{"version", kVersion},
                                                        {"order", bases.order},
                                                        {"channels", bases.channels},
                                                        {"components", bases.components},
                                                        {"bases", write_float_view(contents, bases.rows)},
                                                        {"scales", write_float_view(contents, bases.scales)},
                                                        {"bake", record_json(compressed.record)}};
    contents.use_extension(kClusteredExtension);
}

std::optional<CompressedTransfer> read_clustered(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<CompressedTransfer> {
        const Json* extension = find_extension(contents, kClusteredExtension);
        if (!extension)
            return std::nullopt;
        CompressedTransfer compressed;
        ClusteredBases& bases = compressed.transfer.bases;
        ClusteredReceivers& receivers = compressed.transfer.receivers;
        bases = read_bases(contents, *extension);
        compressed.record = read_record(extension->value("bake", Json::object()));
        receivers.components = (bases.max_components() + 3) / 4 * 4;
        receivers.clusters.resize(scene.receivers());
        for (const Primitive& primitive : scene.primitives) {
            const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
            try {
                const Json& attributes = primitive_json(contents, primitive).at("attributes");
                read_clusters(
                    contents, attributes, bases.clusters(),
                    std::span(receivers.clusters).subspan(vertices.first_receiver, vertices.size()));
                if (receivers.components == 0)
                    continue;
                if (receivers.weights.empty()) {
                    const auto first = attributes.at("_PRT_WEIGHTS_0").get<std::size_t>();
                    receivers.format = weight_format(contents.model.accessors.at(first).componentType);
                    receivers.weights.resize(scene.receivers() *
                                             static_cast<std::size_t>(receivers.components) *
                                             bytes_per_weight(receivers.format));
                }
                read_weights(contents, attributes, vertices.first_receiver, vertices.size(), receivers);
            } catch (const std::exception& error) {
                throw Error(primitive_name(primitive) + ": " + error.what());
            }
        }
        return compressed;
    });
}

} // namespace prt

// Reads raw transfer of vertices, and writes transfer of vertices: docs/format.md.

#include "bake/gltf/stored_transfer.h"

#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/write_set.h"
#include "runtime/load/allowance.h"
#include "runtime/load/coded_vertices.h"
#include "runtime/load/predictors_json.h"
#include "runtime/load/vertex_transfer.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace prt {
namespace {

/// Writes _PRT_CLUSTER: one or two bytes per vertex, aligned to four as glTF requires.
std::size_t write_clusters(GltfContents& contents, std::span<const std::uint16_t> clusters, bool wide) {
    std::vector<std::byte> bytes(clusters.size() * 4);
    for (std::size_t i = 0; i < clusters.size(); ++i)
        std::memcpy(&bytes[i * 4], &clusters[i], wide ? 2 : 1); // little-endian, like glTF
    return contents.add_accessor({{"bufferView", contents.add_buffer_view(bytes, 4, true)},
                                  {"componentType", wide ? kUnsignedShort : kUnsignedByte},
                                  {"count", clusters.size()},
                                  {"type", "SCALAR"}});
}

/// Writes _PRT_WEIGHTS_`group` of receivers [first, first + count).
std::size_t write_weights(GltfContents& contents, const ClusteredReceivers& receivers, std::size_t first,
                          std::size_t count, std::size_t group) {
    const std::size_t size = group_bytes(receivers.format), stride = receivers.stride();
    std::vector<std::byte> bytes(count * size);
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(&bytes[i * size], &receivers.weights[(first + i) * stride + group * size], size);
    return contents.add_accessor({{"bufferView", contents.add_buffer_view(bytes, size, true)},
                                  {"componentType", weight_type(receivers.format)},
                                  {"count", count},
                                  {"type", "VEC4"}});
}

/// Returns the attributes of clusters and weights of the vertices of an array.
Json write_attributes(GltfContents& contents, const ClusteredTransfer& transfer,
                      const VertexArray& vertices) {
    const ClusteredReceivers& receivers = transfer.receivers;
    Json attributes = Json::object();
    if (receivers.format != WeightFormat::packed)
        attributes["_PRT_CLUSTER"] = write_clusters(
            contents, std::span(receivers.clusters).subspan(vertices.first_receiver, vertices.size()),
            transfer.bases.clusters() > 256);
    for (std::size_t group = 0; group < group_count(receivers); ++group)
        attributes[weights_name(group)] =
            write_weights(contents, receivers, vertices.first_receiver, vertices.size(), group);
    return attributes;
}

/// Position of the vectors of one vertex array in a file: `count` numbers, starting at number `first` of all.
struct VectorsView {
    const Json* json;
    std::size_t first, count;
    std::string what;
};

/// Raw transfer of vertices, whose vectors are not read yet.
struct RawVertices {
    TransferLayout layout;
    BakeRecord record;
    std::vector<VectorsView> views;
    std::size_t numbers; ///< of all vectors
};

std::vector<VectorsView> views_of(const GltfContents& contents, const Scene& scene, std::size_t dimension) {
    std::vector<VectorsView> views;
    TransferOfVertices read;
    for (const Primitive& primitive : scene.primitives) {
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        if (vertices.lobes)
            continue;
        const Json* of_primitive = extension_of(primitive_json(contents, primitive), kTransferExtension);
        if (!of_primitive)
            throw Error(primitive_name(primitive) + " has no " + kTransferExtension);
        const Json& view = of_primitive->at("vectors");
        if (read.is_new(primitive, view))
            views.push_back({&view, vertices.first_receiver * dimension, vertices.size() * dimension,
                             "the vectors of " + primitive_name(primitive)});
    }
    return views;
}

/// Returns the raw transfer of the vertices of `scene`; empty if the file has none.
std::optional<RawVertices> find_vectors(const GltfContents& contents, const Scene& scene) {
    const Json* set = find_set(contents, ReceiverKind::vertices, Coding::raw);
    if (!set)
        return std::nullopt;
    check_one_to_one(contents);
    RawVertices raw{read_layout(*set), read_record(set->value("bake", Json::object())), {}, 0};
    raw.views = views_of(contents, scene, raw.layout.dimension());
    raw.numbers = scene.receivers() * raw.layout.dimension();
    return raw;
}

void check_numbers(const GltfContents& contents, std::size_t numbers, std::size_t size) {
    check_allowed(static_cast<double>(numbers) * static_cast<double>(size), contents.file_bytes,
                  "its transfer");
}

} // namespace

void write_transfer(GltfDocument& document, const Scene& scene, const BakedTransfer& baked) {
    named(document, [&](GltfContents& contents) {
        const std::vector<Json*> primitives = meshes_without_transfer(contents, scene);
        const Transfer& transfer = baked.transfer;
        std::vector<Json> views;
        for (const VertexArray& vertices : scene.vertex_arrays)
            views.push_back(vertices.lobes
                                ? Json()
                                : write_vectors(contents,
                                                std::span(transfer.vectors)
                                                    .subspan(vertices.first_receiver * transfer.dimension(),
                                                             vertices.size() * transfer.dimension()),
                                                baked.storage));
        for (std::size_t i = 0; i < primitives.size(); ++i)
            if (const Json& view = views[scene.primitives[i].vertices]; !view.is_null())
                extensions_of(*primitives[i])[kTransferExtension] = {{"vectors", view}};
        add_set(contents, raw_set(ReceiverKind::vertices, baked));
    });
}

void write_clustered(GltfDocument& document, const Scene& scene, const CompressedTransfer& compressed) {
    named(document, [&](GltfContents& contents) {
        const std::vector<Json*> primitives = meshes_without_transfer(contents, scene);
        std::vector<Json> attributes;
        for (const VertexArray& vertices : scene.vertex_arrays)
            attributes.push_back(vertices.lobes ? Json::object()
                                                : write_attributes(contents, compressed.transfer, vertices));
        for (std::size_t i = 0; i < primitives.size(); ++i)
            (*primitives[i])["attributes"].update(attributes[scene.primitives[i].vertices]);
        add_set(contents, write_clustered_set(contents, scene, ReceiverKind::vertices, compressed));
    });
}

std::optional<BakedTransfer> read_transfer(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<BakedTransfer> {
        std::optional<RawVertices> raw = find_vectors(contents, scene);
        if (!raw)
            return std::nullopt;
        check_numbers(contents, raw->numbers, sizeof(float));
        BakedTransfer baked{{std::move(raw->layout), {}}, std::move(raw->record)};
        std::vector<float>& vectors = baked.transfer.vectors;
        vectors.resize(raw->numbers);
        for (const VectorsView& view : raw->views) {
            if (is_half(*view.json))
                baked.storage = TransferStorage::float16;
            read_float_view(contents, *view.json, std::span(vectors).subspan(view.first, view.count),
                            view.what);
        }
        return baked;
    });
}

std::optional<StoredBake> read_stored_transfer(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<StoredBake> {
        std::optional<RawVertices> raw = find_vectors(contents, scene);
        if (!raw)
            return std::nullopt;
        const bool halves =
            std::ranges::all_of(raw->views, [](const VectorsView& view) { return is_half(*view.json); });
        check_numbers(contents, raw->numbers, halves ? sizeof(std::uint16_t) : sizeof(float));
        StoredBake bake{{std::move(raw->layout), {}, {}}, std::move(raw->record)};
        StoredTransfer& transfer = bake.transfer;
        (halves ? transfer.halves.resize(raw->numbers) : transfer.floats.resize(raw->numbers));
        for (const VectorsView& view : raw->views) {
            if (halves)
                read_half_view(contents, *view.json,
                               std::span(transfer.halves).subspan(view.first, view.count), view.what);
            else
                read_float_view(contents, *view.json,
                                std::span(transfer.floats).subspan(view.first, view.count), view.what);
        }
        return bake;
    });
}

std::optional<CompressedTransfer> read_clustered(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) {
        std::optional<CompressedTransfer> compressed = read_clustered(contents, scene);
        if (compressed)
            compressed->transfer.receivers.predictors =
                read_coordinates(contents, scene, compressed->transfer.bases);
        return compressed;
    });
}

} // namespace prt

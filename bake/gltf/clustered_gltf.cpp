// Reads and writes compressed transfer in glTF files: PRTKIT_clustered_pca of docs/format.md.

#include "prt/gltf/gltf.h"

#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/write_clustered_json.h"
#include "runtime/load/coded_vertices.h"
#include "runtime/load/predictors_json.h"
#include "runtime/load/vertex_transfer.h"

#include <cstring>
#include <string>

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

/// Writes predictors and offsets into `extension`; nothing if `bases` has none. Origins of predictors are
/// converted to the file's world.
void write_predictors(GltfContents& contents, const Scene& scene, const ClusteredBases& bases,
                      Json& extension) {
    if (bases.predictors.empty())
        return;
    Json predictors = Json::array();
    for (const Predictor& predictor : bases.predictors) {
        Json json = {{"kind", to_string(predictor.kind)}};
        if (predictor.kind == PredictorKind::position) {
            const glm::dvec3 origin = scene.world(predictor.origin);
            json["origin"] = {origin.x, origin.y, origin.z};
        }
        json["scale"] = {predictor.scale.x, predictor.scale.y, predictor.scale.z};
        predictors.push_back(std::move(json));
    }
    extension["predictors"] = std::move(predictors);
    extension["centers"] = write_row_code(contents, encode_rows(bases.centers, bases.predictor_rows()));
}

void write_into(GltfContents& contents, const Scene& scene, const CompressedTransfer& compressed) {
    const std::vector<Json*> primitives = make_meshes_unique(contents, scene);
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
            added[weights_name(group)] =
                write_weights(contents, receivers, vertices.first_receiver, vertices.size(), group);
        attributes.push_back(std::move(added));
    }
    for (std::size_t i = 0; i < primitives.size(); ++i)
        (*primitives[i])["attributes"].update(attributes[scene.primitives[i].vertices]);
    Json& extension =
        extensions_of(contents.json)[kClusteredExtension] = {{"version", kClusteredVersion},
                                                             {"order", bases.layout.order},
                                                             {"terms", terms_json(bases.layout)},
                                                             {"components", bases.components}};
    write_predictors(contents, scene, bases, extension);
    extension["bases"] = write_bases(contents, bases);
    if (receivers.format == WeightFormat::packed)
        extension["packing"] = write_packing(contents, compressed.transfer);
    extension["bake"] = record_json(compressed.record);
    contents.use_extension(kClusteredExtension);
}

} // namespace

void write_clustered(GltfDocument& document, const Scene& scene, const CompressedTransfer& compressed) {
    named(document, [&](GltfContents& contents) { write_into(contents, scene, compressed); });
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

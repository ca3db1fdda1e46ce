// Reads and writes raw transfer in glTF files: PRTKIT_transfer of docs/format.md.

#include "bake/gltf/stored_transfer.h"

#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/write_transfer_json.h"
#include "runtime/load/allowance.h"

#include <algorithm>

namespace prt {
namespace {

constexpr int kTransferVersion = 5;

void write_into(GltfContents& contents, const Scene& scene, const BakedTransfer& baked) {
    const std::vector<Json*> primitives = make_meshes_unique(contents, scene);
    contents.remove_transfer();
    const Transfer& transfer = baked.transfer;
    std::vector<Json> views;
    const auto write = baked.storage == TransferStorage::float16 ? write_half_view : write_float_view;
    for (const VertexArray& vertices : scene.vertex_arrays)
        views.push_back(write(contents, std::span(transfer.vectors)
                                            .subspan(vertices.first_receiver * transfer.dimension(),
                                                     vertices.size() * transfer.dimension())));
    for (std::size_t i = 0; i < primitives.size(); ++i)
        extensions_of(*primitives[i])[kTransferExtension] = {
            {"vectors", views[scene.primitives[i].vertices]}};
    extensions_of(contents.json)[kTransferExtension] = {{"version", kTransferVersion},
                                                        {"order", transfer.layout.order},
                                                        {"terms", terms_json(transfer.layout)},
                                                        {"bake", record_json(baked.record)}};
    contents.use_extension(kTransferExtension);
}

/// Position of the vectors of one vertex array in a file: `count` numbers, starting at number `first` of all.
struct VectorsView {
    const Json* json;
    std::size_t first, count;
    std::string what;
};

std::vector<VectorsView> views_of(const GltfContents& contents, const Scene& scene, std::size_t dimension) {
    std::vector<VectorsView> views;
    TransferOfVertices read;
    for (const Primitive& primitive : scene.primitives) {
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
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

} // namespace

void write_transfer(GltfDocument& document, const Scene& scene, const BakedTransfer& baked) {
    named(document, [&](GltfContents& contents) { write_into(contents, scene, baked); });
}

std::optional<BakedTransfer> read_transfer(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<BakedTransfer> {
        const Json* extension = find_extension(contents, kTransferExtension, kTransferVersion);
        if (!extension)
            return std::nullopt;
        check_one_to_one(contents);
        BakedTransfer baked;
        Transfer& transfer = baked.transfer;
        transfer.layout = read_layout(*extension);
        baked.record = read_record(extension->value("bake", Json::object()));
        check_allowed(static_cast<double>(scene.receivers()) *
                          static_cast<double>(transfer.dimension() * sizeof(float)),
                      contents.file_bytes, "its transfer");
        transfer.vectors.resize(scene.receivers() * transfer.dimension());
        for (const VectorsView& view : views_of(contents, scene, transfer.dimension())) {
            if (is_half(*view.json))
                baked.storage = TransferStorage::float16;
            read_float_view(contents, *view.json, std::span(transfer.vectors).subspan(view.first, view.count),
                            view.what);
        }
        return baked;
    });
}

std::optional<StoredBake> read_stored_transfer(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<StoredBake> {
        const Json* extension = find_extension(contents, kTransferExtension, kTransferVersion);
        if (!extension)
            return std::nullopt;
        check_one_to_one(contents);
        StoredBake bake;
        StoredTransfer& transfer = bake.transfer;
        transfer.layout = read_layout(*extension);
        bake.record = read_record(extension->value("bake", Json::object()));
        const std::size_t dimension = transfer.layout.dimension();
        const std::vector<VectorsView> views = views_of(contents, scene, dimension);
        const bool halves =
            std::ranges::all_of(views, [](const VectorsView& view) { return is_half(*view.json); });
        check_allowed(static_cast<double>(scene.receivers()) *
                          static_cast<double>(dimension * (halves ? sizeof(std::uint16_t) : sizeof(float))),
                      contents.file_bytes, "its transfer");
        (halves ? transfer.halves.resize(scene.receivers() * dimension)
                : transfer.floats.resize(scene.receivers() * dimension));
        for (const VectorsView& view : views) {
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

} // namespace prt

// Raw transfer in glTF files: PRTKIT_transfer of docs/format.md.

#include "prt/gltf.h"

#include "gltf/allowance.h"
#include "gltf/transfer_json.h"
#include "gltf/unshare.h"

#include <algorithm>

namespace prt {
namespace {

constexpr int kTransferVersion = 4;

void write_into(GltfContents& contents, const Scene& scene, const BakedTransfer& baked) {
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
        extensions_of(*primitives[i])[kTransferExtension] = {
            {"vectors", views[scene.primitives[i].vertices]}};
    extensions_of(contents.json)[kTransferExtension] = {{"version", kTransferVersion},
                                                        {"order", transfer.layout.order},
                                                        {"parts", parts_json(transfer.layout)},
                                                        {"bake", record_json(baked.record)}};
    contents.use_extension(kTransferExtension);
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
        BakedTransfer baked;
        Transfer& transfer = baked.transfer;
        transfer.layout = read_layout(*extension);
        baked.record = read_record(extension->value("bake", Json::object()));
        check_allowed(static_cast<double>(scene.receivers()) *
                          static_cast<double>(transfer.dimension() * sizeof(float)),
                      contents.file_bytes, "its transfer");
        transfer.vectors.resize(scene.receivers() * transfer.dimension());
        TransferOfVertices read;
        for (const Primitive& primitive : scene.primitives) {
            const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
            const Json* of_primitive = extension_of(primitive_json(contents, primitive), kTransferExtension);
            if (!of_primitive)
                throw Error(primitive_name(primitive) + " has no " + kTransferExtension);
            const Json& view = of_primitive->at("vectors");
            if (!read.is_new(primitive, view))
                continue;
            if (is_half(view))
                baked.storage = TransferStorage::float16;
            read_float_view(contents, view,
                            std::span(transfer.vectors)
                                .subspan(vertices.first_receiver * transfer.dimension(),
                                         vertices.size() * transfer.dimension()),
                            "the vectors of " + primitive_name(primitive));
        }
        return baked;
    });
}

} // namespace prt

// Writes occlusion volumes of nodes in glTF files: PRTKIT_occlusion_volume of docs/format.md.

#include "prt/gltf/transfer_gltf.h"

#include "bake/gltf/write_set.h"
#include "runtime/load/occluder_nodes.h"

#include <set>
#include <string>

namespace prt {
namespace {

void remove_occluders(GltfContents& contents) {
    if (!contents.json.contains("nodes"))
        return;
    std::set<std::size_t> views;
    for (Json& node : contents.json["nodes"]) {
        const Json* extension = extension_of(node, kOccluderExtension);
        if (!extension)
            continue;
        if (extension->contains("texels"))
            if (const Json& texels = (*extension)["texels"]; texels.is_object() &&
                                                             texels.contains("bufferView") &&
                                                             texels["bufferView"].is_number_unsigned())
                views.insert(texels["bufferView"].get<std::size_t>());
        erase_extension(node, kOccluderExtension);
    }
    contents.remove_unused({}, std::move(views));
    drop_extension(contents.json, kOccluderExtension);
}

} // namespace

void write_occluders(GltfDocument& document, std::span<const NodeOccluder> occluders) {
    named(document, [&](GltfContents& contents) {
        remove_occluders(contents);
        for (const NodeOccluder& occluder : occluders) {
            const OcclusionVolume& volume = occluder.volume;
            const std::size_t view = contents.add_buffer_view(std::as_bytes(std::span(volume.texels)));
            Json& node = contents.json.at("nodes").at(static_cast<std::size_t>(occluder.node));
            extensions_of(node)[kOccluderExtension] = {{"version", kOccluderVersion},
                                                       {"min", {volume.low.x, volume.low.y, volume.low.z}},
                                                       {"max", {volume.high.x, volume.high.y, volume.high.z}},
                                                       {"reach", volume.reach},
                                                       {"texels", {{"bufferView", view}}}};
        }
        if (!occluders.empty())
            contents.use_extension(kOccluderExtension);
    });
}

std::vector<NodeOccluder> read_occluders(const GltfDocument& document) {
    return named(document, [](const GltfContents& contents) { return read_occluders(contents); });
}

} // namespace prt

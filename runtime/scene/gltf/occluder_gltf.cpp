// Reads and writes occlusion volumes of nodes in glTF files: PRTKIT_occlusion_volume of docs/format.md.

#include "prt/gltf/transfer_gltf.h"

#include "runtime/scene/gltf/accessor.h"
#include "runtime/scene/gltf/transfer_json.h"

#include <cstring>
#include <set>
#include <string>

namespace prt {
namespace {

constexpr int kOccluderVersion = 1;

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
        node["extensions"].erase(kOccluderExtension);
        if (node["extensions"].empty())
            node.erase("extensions");
    }
    contents.remove_unused({}, std::move(views));
    contents.drop_extension(kOccluderExtension);
}

glm::vec3 read_corner(const Json& json, const char* name) {
    const Json& corner = json.at(name);
    if (!corner.is_array() || corner.size() != 3)
        throw Error(std::string(name) + " of an occlusion volume is not a list of three numbers");
    return {corner[0].get<float>(), corner[1].get<float>(), corner[2].get<float>()};
}

OcclusionVolume read_occluder(const GltfContents& contents, const Json& json) {
    const Json version = json.value("version", Json(0));
    if (!version.is_number_integer() || version != kOccluderVersion)
        throw Error(std::string(kOccluderExtension) + " has version " + version.dump() +
                    ", but this program reads version " + std::to_string(kOccluderVersion) +
                    "; write the file again with this version of prt");
    OcclusionVolume volume;
    volume.low = read_corner(json, "min");
    volume.high = read_corner(json, "max");
    volume.reach = json.at("reach").get<float>();
    check_occlusion_volume(volume);
    const auto bytes = buffer_view_bytes(contents.model, json.at("texels").at("bufferView").get<int>());
    if (bytes.size() != sizeof volume.texels)
        throw Error("an occlusion volume has " + std::to_string(bytes.size()) +
                    " bytes of texels, but must have " + std::to_string(sizeof volume.texels));
    std::memcpy(volume.texels.data(), bytes.data(), bytes.size());
    return volume;
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
    return named(document, [](const GltfContents& contents) {
        std::vector<NodeOccluder> occluders;
        if (!contents.json.contains("nodes"))
            return occluders;
        const Json& nodes = contents.json["nodes"];
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (const Json* extension = extension_of(nodes[n], kOccluderExtension)) {
                try {
                    occluders.push_back({static_cast<int>(n), read_occluder(contents, *extension)});
                } catch (const std::exception& error) {
                    throw Error("node " + std::to_string(n) + ": " + in_plain_words(error));
                }
            }
        return occluders;
    });
}

} // namespace prt

// Reads compressed transfer of texels: docs/format.md.
#include "runtime/load/texel_transfer.h"

#include "runtime/core/support/counted.h"
#include "runtime/load/allowance.h"
#include "runtime/load/clustered_set.h"
#include "runtime/load/receiver_sets.h"
#include "runtime/load/transfer_json.h"

#include <cstdint>
#include <string>
#include <vector>

namespace prt {
namespace {

LightmapSize read_map(const Json& json) {
    LightmapSize map{whole_number(json.at("width"), "the width of a map", 1, kMaxLightmapTexels),
                     whole_number(json.at("height"), "the height of a map", 1, kMaxLightmapTexels)};
    map.repeats = json.value("repeats", false);
    return map;
}

LightmapPlacement read_position(const Json& json, const VertexArray& vertices, std::size_t maps) {
    const LightmapPlacement position{
        static_cast<std::size_t>(
            whole_number(json.at("map"), "the index of a map", 0, static_cast<int>(maps) - 1)),
        whole_number(json.at("texCoord"), "texCoord", 0, 1000)};
    const auto set = static_cast<std::size_t>(position.texcoord);
    if (set >= vertices.texcoords.size() || vertices.texcoords[set].empty())
        throw Error("it has no TEXCOORD_" + std::to_string(position.texcoord) +
                    ", but its lightmap needs it");
    return position;
}

/// Reads the word images of all maps. One image may hold several words.
std::vector<std::vector<std::byte>> read_images(const GltfData& data, const Json& maps, std::size_t words,
                                                std::size_t count, const ImageBytes& bytes_of) {
    std::vector<std::vector<std::byte>> all;
    double bytes = 0;
    for (const Json& map : maps) {
        const Json& images = map.at("images");
        if (!images.is_array() || images.size() != words)
            throw Error("a map has " + counted(images.size(), "image") + ", but a texel has " +
                        std::to_string(words) + " words");
        if (count == 0)
            throw Error("the file has no images for the maps");
        for (const Json& image : images) {
            const int most = static_cast<int>(count) - 1;
            const auto file =
                bytes_of(static_cast<std::size_t>(whole_number(image, "an image of a map", 0, most)));
            check_allowed(bytes += static_cast<double>(file.size()), data.file_bytes,
                          "the images of its lightmaps");
            all.emplace_back(file.begin(), file.end());
        }
    }
    return all;
}

} // namespace

LightmapLayout read_layout_of_maps(const GltfData& data, const Scene& scene, const Json& set) {
    if (extension_of(data.json, kInstancesExtension))
        throw Error("has texels, but its instances share transfer of vertices; run prt bake again");
    LightmapLayout layout;
    const Json& maps = set.at("maps");
    if (!maps.is_array() || maps.empty())
        throw Error("the list of maps is missing or empty");
    for (const Json& map : maps)
        layout.maps.push_back(read_map(map));
    check_allowed(8 * static_cast<double>(layout.texels()), data.file_bytes, "its lightmaps");
    for (const Primitive& primitive : scene.primitives) {
        if (scene.vertex_arrays[primitive.vertices].lobes) {
            layout.placements.push_back({.map = kNoMap});
            continue;
        }
        const Json* of_primitive = extension_of(primitive_json(data, primitive), kTransferExtension);
        if (!of_primitive)
            throw Error(primitive_name(primitive) + " has no " + kTransferExtension);
        try {
            layout.placements.push_back(
                read_position(*of_primitive, scene.vertex_arrays[primitive.vertices], layout.maps.size()));
        } catch (const std::exception& error) {
            throw Error(primitive_name(primitive) + ": " + in_plain_words(error));
        }
    }
    return layout;
}

std::optional<EncodedLightmap> read_encoded_lightmap(const GltfData& data, const Scene& scene,
                                                     std::size_t images, const ImageBytes& image) {
    const Json* set = find_set(data, ReceiverKind::texels, Coding::clustered);
    if (!set)
        return std::nullopt;
    EncodedLightmap encoded{{read_layout_of_maps(data, scene, *set), read_clustered_set(data, scene, *set)},
                            {}};
    const ClusteredReceivers& receivers = encoded.lightmap.compressed.transfer.receivers;
    const double bytes = static_cast<double>(receivers.stride() + sizeof(std::uint16_t));
    check_allowed(bytes * static_cast<double>(encoded.lightmap.layout.texels()), data.file_bytes,
                  "the texels of its lightmaps");
    encoded.images =
        read_images(data, set->at("maps"), static_cast<std::size_t>(receivers.words), images, image);
    return encoded;
}

} // namespace prt

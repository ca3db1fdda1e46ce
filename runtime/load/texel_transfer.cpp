// Reads compressed transfer of texels: PRTKIT_lightmap of docs/format.md.
#include "runtime/load/texel_transfer.h"

#include "runtime/load/allowance.h"
#include "runtime/load/clustered_json.h"
#include "runtime/support/counted.h"

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

EncodedLightmap read_encoded(const GltfData& data, const Scene& scene, const Json& extension,
                             std::size_t count, const ImageBytes& image) {
    EncodedLightmap encoded;
    CompressedLightmap& lightmap = encoded.lightmap;
    ClusteredTransfer& transfer = lightmap.compressed.transfer;
    lightmap.layout = read_layout_of_maps(data, scene, extension);
    transfer.bases = read_clusters_of(extension);
    lightmap.compressed.record = read_record(extension.value("bake", Json::object()));
    read_bases(data, extension.at("bases"), transfer.bases);
    read_packing(data, extension.at("packing"), transfer);
    const double bytes = static_cast<double>(transfer.receivers.stride() + sizeof(std::uint16_t));
    check_allowed(bytes * static_cast<double>(lightmap.layout.texels()), data.file_bytes,
                  "the texels of its lightmaps");
    encoded.images = read_images(data, extension["maps"], static_cast<std::size_t>(transfer.receivers.words),
                                 count, image);
    return encoded;
}

} // namespace

const Json* find_lightmap(const GltfData& data) {
    const Json* extension = find_extension(data, kLightmapExtension, kLightmapVersion);
    for (const char* other : {kTransferExtension, kClusteredExtension})
        if (extension && extension_of(data.json, other))
            throw Error(std::string("has ") + kLightmapExtension + " and " + other +
                        "; a file can have transfer at texels or at vertices, not both");
    if (extension && extension->contains("raw") && extension->contains("components"))
        throw Error("has both raw vectors and clusters");
    if (extension && extension->contains("predictors"))
        throw Error("has predictors, but texels do not support them");
    return extension;
}

LightmapLayout read_layout_of_maps(const GltfData& data, const Scene& scene, const Json& extension) {
    LightmapLayout layout;
    const Json& maps = extension.at("maps");
    if (!maps.is_array() || maps.empty())
        throw Error("the list of maps is missing or empty");
    for (const Json& map : maps)
        layout.maps.push_back(read_map(map));
    check_allowed(8 * static_cast<double>(layout.texels()), data.file_bytes, "its lightmaps");
    for (const Primitive& primitive : scene.primitives) {
        const Json* of_primitive = extension_of(primitive_json(data, primitive), kLightmapExtension);
        if (!of_primitive)
            throw Error(primitive_name(primitive) + " has no " + kLightmapExtension);
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
    const Json* extension = find_lightmap(data);
    if (!extension || extension->contains("raw"))
        return std::nullopt;
    return read_encoded(data, scene, *extension, images, image);
}

} // namespace prt

// Reads raw transfer of texels, and writes transfer of texels: docs/format.md.

#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/read_raw_set.h"
#include "bake/gltf/write_set.h"
#include "prt/gltf/transfer_gltf.h"
#include "runtime/load/accessor.h"
#include "runtime/load/texel_transfer.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace prt {
namespace {

/// Returns the members "maps" of the set and of the primitives of `scene`; changes the meshes.
Json write_maps(GltfContents& contents, const Scene& scene, const LightmapLayout& layout) {
    const std::vector<Json*> primitives = meshes_without_transfer(contents, scene);
    for (std::size_t p = 0; p < primitives.size(); ++p)
        if (layout.placements[p].map != kNoMap)
            extensions_of(*primitives[p])[kTransferExtension] = {{"map", layout.placements[p].map},
                                                                 {"texCoord", layout.placements[p].texcoord}};
    Json maps = Json::array();
    for (const LightmapSize& map : layout.maps)
        maps.push_back({{"width", map.width}, {"height", map.height}, {"repeats", map.repeats}});
    return maps;
}

/// Returns the bytes of {"bufferView": ...} as 32-bit integers.
std::vector<std::uint32_t> read_numbers(const GltfContents& contents, const Json& json,
                                        const std::string& what) {
    const auto bytes = buffer_view_bytes(contents.model, json.at("bufferView").get<int>());
    if (bytes.size() % sizeof(std::uint32_t) != 0)
        throw Error(what + " are not 32-bit integers: the size of their buffer view is not a multiple of 4");
    std::vector<std::uint32_t> numbers(bytes.size() / sizeof(std::uint32_t));
    if (!numbers.empty())
        std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
}

std::vector<std::uint32_t> read_texels(const GltfContents& contents, const Json& set, std::size_t texels) {
    std::vector<std::uint32_t> numbers = read_numbers(contents, set.at("texels"), "the texels");
    if (numbers.empty())
        throw Error("the list of texels is empty");
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] >= texels || (i > 0 && numbers[i] <= numbers[i - 1]))
            throw Error("the texels are not in ascending order, or an index is outside the maps");
    return numbers;
}

std::vector<Edge> read_seams(const GltfContents& contents, const Json& set, std::size_t receivers) {
    if (!set.contains("seams"))
        return {};
    const std::vector<std::uint32_t> numbers = read_numbers(contents, set["seams"], "the seams");
    if (numbers.size() % 2 != 0)
        throw Error("the seams are not pairs: their number of texels is odd");
    std::vector<Edge> seams;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
        if (std::max(numbers[i], numbers[i + 1]) >= receivers)
            throw Error("a seam refers to receiver " + std::to_string(std::max(numbers[i], numbers[i + 1])) +
                        ", but there are only " + std::to_string(receivers));
        seams.push_back({numbers[i], numbers[i + 1]});
    }
    return unique_edges(std::move(seams));
}

/// Embeds the images of all words; adds them to `maps`.
void write_images(GltfContents& contents, const EncodedLightmap& encoded, Json& maps) {
    const std::size_t words = encoded.images.size() / maps.size();
    for (std::size_t m = 0; m < maps.size(); ++m) {
        Json images = Json::array();
        for (std::size_t w = 0; w < words; ++w) {
            const std::size_t view = contents.add_buffer_view(encoded.images[m * words + w]);
            Json& all = member(contents.json, "images", Json::value_t::array);
            images.push_back(all.size());
            all.push_back({{"name", "lightmap " + std::to_string(m) + " word " + std::to_string(w)},
                           {"bufferView", view},
                           {"mimeType", "image/png"}});
        }
        maps[m]["images"] = std::move(images);
    }
}

} // namespace

void write_lightmap(GltfDocument& document, const Scene& scene, const BakedLightmap& lightmap) {
    named(document, [&](GltfContents& contents) {
        std::vector<std::uint32_t> seams;
        for (const Edge& seam : lightmap.seams)
            seams.insert(seams.end(), {seam.first, seam.second});
        Json set = raw_set(ReceiverKind::texels, lightmap.baked);
        set["maps"] = write_maps(contents, scene, lightmap.layout);
        set["texels"] = write_view(contents, std::span(lightmap.texels));
        set["areas"] = write_float_view(contents, lightmap.areas);
        if (!seams.empty())
            set["seams"] = write_view(contents, std::span<const std::uint32_t>(seams));
        set["vectors"] = write_vectors(contents, lightmap.baked.transfer.vectors, lightmap.baked.storage);
        add_set(contents, std::move(set));
    });
}

std::optional<BakedLightmap> read_lightmap(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<BakedLightmap> {
        const Json* set = find_set(contents, ReceiverKind::texels, Coding::raw);
        if (!set)
            return std::nullopt;
        BakedLightmap lightmap;
        lightmap.layout = read_layout_of_maps(contents, scene, *set);
        lightmap.texels = read_texels(contents, *set, lightmap.layout.texels());
        const std::size_t receivers = lightmap.texels.size();
        lightmap.areas = read_float_view(contents, set->at("areas"), receivers, 1e18f, "the areas");
        if (std::ranges::any_of(lightmap.areas, [](float area) { return area < 0; }))
            throw Error("an area is negative");
        lightmap.seams = read_seams(contents, *set, receivers);
        lightmap.baked = read_raw_set(contents, *set, receivers);
        return lightmap;
    });
}

void write_encoded_lightmap(GltfDocument& document, const Scene& scene, const EncodedLightmap& encoded) {
    named(document, [&](GltfContents& contents) {
        Json maps = write_maps(contents, scene, encoded.lightmap.layout);
        write_images(contents, encoded, maps);
        Json set = write_clustered_set(contents, scene, ReceiverKind::texels, encoded.lightmap.compressed);
        set["maps"] = std::move(maps);
        add_set(contents, std::move(set));
    });
}

std::optional<EncodedLightmap> read_encoded_lightmap(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<EncodedLightmap> {
        return read_encoded_lightmap(contents, scene, contents.images.size(), [&](std::size_t image) {
            return std::span<const std::byte>(contents.images[image]);
        });
    });
}

} // namespace prt

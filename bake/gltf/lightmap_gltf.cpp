// Reads and writes transfer of texels in glTF files: PRTKIT_lightmap of docs/format.md.

#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/write_clustered_json.h"
#include "prt/gltf/transfer_gltf.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/texel_transfer.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace prt {
namespace {

Json maps_json(const LightmapLayout& layout) {
    Json maps = Json::array();
    for (const LightmapSize& map : layout.maps)
        maps.push_back({{"width", map.width}, {"height", map.height}, {"repeats", map.repeats}});
    return maps;
}

/// Writes the extension at the top level, and the maps of primitives.
Json& write_layout(GltfContents& contents, const Scene& scene, const LightmapLayout& layout,
                   const TransferLayout& transfer) {
    const std::vector<Json*> primitives = make_meshes_unique(contents, scene);
    contents.remove_transfer();
    for (std::size_t p = 0; p < primitives.size(); ++p)
        extensions_of(*primitives[p])[kLightmapExtension] = {{"map", layout.placements[p].map},
                                                             {"texCoord", layout.placements[p].texcoord}};
    contents.use_extension(kLightmapExtension);
    return extensions_of(contents.json)[kLightmapExtension] = {{"version", kLightmapVersion},
                                                               {"order", transfer.order},
                                                               {"terms", terms_json(transfer)},
                                                               {"maps", maps_json(layout)}};
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

Json write_numbers(GltfContents& contents, std::span<const std::uint32_t> numbers) {
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(numbers))}};
}

std::vector<std::uint32_t> read_texels(const GltfContents& contents, const Json& raw, std::size_t texels) {
    std::vector<std::uint32_t> numbers = read_numbers(contents, raw.at("texels"), "the texels");
    if (numbers.empty())
        throw Error("the list of texels is empty");
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] >= texels || (i > 0 && numbers[i] <= numbers[i - 1]))
            throw Error("the texels are not in ascending order, or an index is outside the maps");
    return numbers;
}

std::vector<Edge> read_seams(const GltfContents& contents, const Json& raw, std::size_t receivers) {
    if (!raw.contains("seams"))
        return {};
    const std::vector<std::uint32_t> numbers = read_numbers(contents, raw["seams"], "the seams");
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

void read_raw(const GltfContents& contents, const Json& raw, BakedLightmap& lightmap) {
    lightmap.texels = read_texels(contents, raw, lightmap.layout.texels());
    const std::size_t receivers = lightmap.texels.size();
    lightmap.areas = read_float_view(contents, raw.at("areas"), receivers, 1e18f, "the areas");
    if (std::ranges::any_of(lightmap.areas, [](float area) { return area < 0; }))
        throw Error("an area is negative");
    lightmap.seams = read_seams(contents, raw, receivers);
    Transfer& transfer = lightmap.baked.transfer;
    const double bytes =
        static_cast<double>(receivers) * static_cast<double>(transfer.dimension() * sizeof(float));
    check_allowed(bytes, contents.file_bytes, "its transfer");
    transfer.vectors.resize(receivers * transfer.dimension());
    const Json& vectors = raw.at("vectors");
    lightmap.baked.storage = is_half(vectors) ? TransferStorage::float16 : TransferStorage::float32;
    read_float_view(contents, vectors, std::span(transfer.vectors), "the vectors of texels");
}

void write_raw(GltfContents& contents, const Scene& scene, const BakedLightmap& lightmap) {
    const Transfer& transfer = lightmap.baked.transfer;
    write_layout(contents, scene, lightmap.layout, transfer.layout);
    std::vector<std::uint32_t> seams;
    for (const Edge& seam : lightmap.seams)
        seams.insert(seams.end(), {seam.first, seam.second});
    const auto write =
        lightmap.baked.storage == TransferStorage::float16 ? write_half_view : write_float_view;
    Json raw = {{"texels", write_numbers(contents, lightmap.texels)},
                {"areas", write_float_view(contents, lightmap.areas)}};
    if (!seams.empty())
        raw["seams"] = write_numbers(contents, seams);
    raw["vectors"] = write(contents, transfer.vectors);
    Json& extension = contents.json["extensions"][kLightmapExtension];
    extension["raw"] = std::move(raw);
    extension["bake"] = record_json(lightmap.baked.record);
}

void write_encoded(GltfContents& contents, const Scene& scene, const EncodedLightmap& encoded) {
    const CompressedLightmap& lightmap = encoded.lightmap;
    const ClusteredTransfer& transfer = lightmap.compressed.transfer;
    write_layout(contents, scene, lightmap.layout, transfer.bases.layout);
    const std::size_t maps = lightmap.layout.maps.size(), words = encoded.images.size() / maps;
    for (std::size_t m = 0; m < maps; ++m) {
        Json images = Json::array();
        for (std::size_t w = 0; w < words; ++w) {
            const std::size_t view = contents.add_buffer_view(encoded.images[m * words + w]);
            Json& all = member(contents.json, "images", Json::value_t::array);
            images.push_back(all.size());
            all.push_back({{"name", "lightmap " + std::to_string(m) + " word " + std::to_string(w)},
                           {"bufferView", view},
                           {"mimeType", "image/png"}});
        }
        contents.json["extensions"][kLightmapExtension]["maps"][m]["images"] = std::move(images);
    }
    Json bases = write_bases(contents, transfer.bases), packing = write_packing(contents, transfer);
    Json& extension = contents.json["extensions"][kLightmapExtension];
    extension["components"] = transfer.bases.components;
    extension["bases"] = std::move(bases);
    extension["packing"] = std::move(packing);
    extension["bake"] = record_json(lightmap.compressed.record);
}

} // namespace

void write_lightmap(GltfDocument& document, const Scene& scene, const BakedLightmap& lightmap) {
    named(document, [&](GltfContents& contents) { write_raw(contents, scene, lightmap); });
}

std::optional<BakedLightmap> read_lightmap(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<BakedLightmap> {
        const Json* extension = find_lightmap(contents);
        if (!extension || !extension->contains("raw"))
            return std::nullopt;
        BakedLightmap lightmap;
        lightmap.layout = read_layout_of_maps(contents, scene, *extension);
        lightmap.baked.transfer.layout = read_layout(*extension);
        lightmap.baked.record = read_record(extension->value("bake", Json::object()));
        read_raw(contents, extension->at("raw"), lightmap);
        return lightmap;
    });
}

void write_encoded_lightmap(GltfDocument& document, const Scene& scene, const EncodedLightmap& lightmap) {
    named(document, [&](GltfContents& contents) { write_encoded(contents, scene, lightmap); });
}

std::optional<EncodedLightmap> read_encoded_lightmap(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<EncodedLightmap> {
        return read_encoded_lightmap(contents, scene, contents.images.size(), [&](std::size_t image) {
            return std::span<const std::byte>(contents.images[image]);
        });
    });
}

} // namespace prt

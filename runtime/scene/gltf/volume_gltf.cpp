// Reads and writes transfer of probes in glTF files: PRTKIT_transfer_volume of docs/format.md.

#include "prt/gltf/transfer_gltf.h"
#include "runtime/support/counted.h"

#include "runtime/scene/gltf/accessor.h"
#include "runtime/scene/gltf/allowance.h"
#include "runtime/scene/gltf/clustered_json.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace prt {
namespace {

constexpr int kVolumeVersion = 2;

/// Writes four uint16 per brick.
Json write_bricks(GltfContents& contents, const VolumeGrid& grid) {
    std::vector<std::uint16_t> numbers;
    for (const VolumeBrick& brick : grid.bricks)
        for (const int n : {brick.position.x, brick.position.y, brick.position.z, brick.level})
            numbers.push_back(static_cast<std::uint16_t>(n));
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(std::span(numbers)))}};
}

std::vector<std::byte> bytes_of(const GltfContents& contents, const Json& json) {
    const auto bytes = std::as_bytes(buffer_view_bytes(contents.model, json.at("bufferView").get<int>()));
    return {bytes.begin(), bytes.end()};
}

/// Converts an origin from the world to the frame of positions in `scene`.
glm::vec3 read_origin(const Scene& scene, const Json& json) {
    if (!json.is_array() || json.size() != 3)
        throw Error("the origin of the volume is not a list of three numbers");
    return glm::vec3(glm::dvec3(json[0].get<double>(), json[1].get<double>(), json[2].get<double>()) -
                     scene.origin);
}

VolumeGrid read_grid(const GltfContents& contents, const Scene& scene, const Json& json) {
    VolumeGrid grid;
    grid.origin = read_origin(scene, json.at("origin"));
    grid.spacing = json.at("spacing").get<float>();
    const Json& size = json.at("size");
    if (!size.is_array() || size.size() != 3)
        throw Error("the size of the volume is not a list of three numbers");
    for (int a = 0; a < 3; ++a)
        grid.size[a] =
            whole_number(size[static_cast<std::size_t>(a)], "the size of the volume", 1, kMaxBricksAlong);
    check_allowed(16.0 * grid.size.x * grid.size.y * grid.size.z, contents.file_bytes, "its volume");
    const std::vector<std::byte> bytes = bytes_of(contents, json.at("bricks"));
    if (bytes.size() % 8 != 0)
        throw Error("the size of the bricks of the volume is not a multiple of 8 bytes");
    std::vector<std::uint16_t> numbers(bytes.size() / 2);
    if (!bytes.empty())
        std::memcpy(numbers.data(), bytes.data(), bytes.size());
    for (std::size_t i = 0; i < numbers.size(); i += 4)
        grid.bricks.push_back({{numbers[i], numbers[i + 1], numbers[i + 2]}, numbers[i + 3]});
    check_grid(grid);
    check_allowed(static_cast<double>(grid.bricks.size()) * kBrickProbes * 64, contents.file_bytes,
                  "its volume");
    return grid;
}

Json write_visibility(GltfContents& contents, const std::vector<ProbeVisibility>& visibility) {
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(std::span(visibility)))}};
}

std::vector<ProbeVisibility> read_visibility(const GltfContents& contents, const Json& json,
                                             std::size_t probes) {
    const std::vector<std::byte> bytes = bytes_of(contents, json);
    std::vector<ProbeVisibility> visibility(probes);
    if (bytes.size() != probes * sizeof(ProbeVisibility))
        throw Error("the volume has " + std::to_string(probes) + " probes, but visibility distances for " +
                    std::to_string(bytes.size() / sizeof(ProbeVisibility)));
    if (!bytes.empty())
        std::memcpy(visibility.data(), bytes.data(), bytes.size());
    return visibility;
}

/// Writes the common part of the extension. `transfer` is the layout of one coefficient of incident light.
template <class Volume>
Json& write_common(GltfContents& contents, const Scene& scene, const Volume& volume,
                   const TransferLayout& transfer) {
    const glm::dvec3 origin = scene.world(volume.grid.origin);
    contents.remove_volume();
    contents.use_extension(kVolumeExtension);
    Json extension = {{"version", kVolumeVersion},
                      {"order", transfer.order},
                      {"incidentOrder", volume.order},
                      {"terms", terms_json(transfer)},
                      {"origin", {origin.x, origin.y, origin.z}},
                      {"spacing", volume.grid.spacing},
                      {"size", {volume.grid.size.x, volume.grid.size.y, volume.grid.size.z}},
                      {"bricks", write_bricks(contents, volume.grid)},
                      {"visibility", write_visibility(contents, volume.visibility)}};
    return extensions_of(contents.json)[kVolumeExtension] = std::move(extension);
}

/// Reads grid, order and visibility. Returns the number of probes.
template <class Volume>
std::size_t read_common(const GltfContents& contents, const Scene& scene, const Json& extension,
                        Volume& volume) {
    volume.order = whole_number(extension.at("incidentOrder"), "incidentOrder", 2, kMaxIncidentOrder);
    volume.grid = read_grid(contents, scene, extension);
    const std::size_t probes = probes_of(volume.grid).size();
    volume.visibility = read_visibility(contents, extension.at("visibility"), probes);
    return probes;
}

void write_words(GltfContents& contents, const Scene& scene, const CompressedVolume& volume) {
    const ClusteredTransfer& transfer = volume.compressed.transfer;
    if (transfer.receivers.format != WeightFormat::packed)
        throw Error("the weights of probes must be packed; compress with --bits N");
    write_common(contents, scene, volume, transfer.bases.layout);
    Json bases = write_bases(contents, transfer.bases), packing = write_packing(contents, transfer);
    const std::size_t view = contents.add_buffer_view(transfer.receivers.weights);
    Json& extension = contents.json["extensions"][kVolumeExtension];
    extension["components"] = transfer.bases.components;
    extension["bases"] = std::move(bases);
    extension["packing"] = std::move(packing);
    extension["words"] = {{"bufferView", view}};
    extension["bake"] = record_json(volume.compressed.record);
}

CompressedVolume read_words(const GltfContents& contents, const Scene& scene, const Json& extension) {
    CompressedVolume volume;
    const std::size_t probes = read_common(contents, scene, extension, volume);
    ClusteredTransfer& transfer = volume.compressed.transfer;
    transfer.bases = read_clusters_of(extension, static_cast<std::size_t>(coefficient_count(volume.order)));
    volume.compressed.record = read_record(extension.value("bake", Json::object()));
    read_bases(contents, extension.at("bases"), transfer.bases);
    read_packing(contents, extension.at("packing"), transfer);
    ClusteredReceivers& receivers = transfer.receivers;
    receivers.weights = bytes_of(contents, extension.at("words"));
    receivers.clusters.resize(probes);
    if (receivers.weights.size() != probes * receivers.stride())
        throw Error("the size of the packed weights of the volume does not match its " +
                    counted(probes, "probe"));
    unpack_clusters(transfer.bases.clusters(), 0, probes, "probe", receivers);
    return volume;
}

} // namespace

void write_volume(GltfDocument& document, const Scene& scene, const BakedVolume& volume) {
    named(document, [&](GltfContents& contents) {
        const Transfer& transfer = volume.baked.transfer;
        write_common(contents, scene, volume, transfer.layout);
        const auto write =
            volume.baked.storage == TransferStorage::float16 ? write_half_view : write_float_view;
        Json raw = {{"vectors", write(contents, transfer.vectors)}};
        Json& extension = contents.json["extensions"][kVolumeExtension];
        extension["raw"] = std::move(raw);
        extension["bake"] = record_json(volume.baked.record);
    });
}

void write_volume(GltfDocument& document, const Scene& scene, const CompressedVolume& volume) {
    named(document, [&](GltfContents& contents) { write_words(contents, scene, volume); });
}

std::optional<BakedVolume> read_volume(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<BakedVolume> {
        const Json* extension = find_extension(contents, kVolumeExtension, kVolumeVersion);
        if (!extension || !extension->contains("raw"))
            return std::nullopt;
        BakedVolume volume;
        const std::size_t probes = read_common(contents, scene, *extension, volume);
        volume.baked.record = read_record(extension->value("bake", Json::object()));
        Transfer& transfer = volume.baked.transfer;
        transfer.layout = read_layout(*extension);
        const std::size_t numbers = probes * volume.coefficients() * transfer.dimension();
        check_allowed(static_cast<double>(numbers) * sizeof(float), contents.file_bytes, "its transfer");
        transfer.vectors.resize(numbers);
        const Json& vectors = extension->at("raw").at("vectors");
        volume.baked.storage = is_half(vectors) ? TransferStorage::float16 : TransferStorage::float32;
        read_float_view(contents, vectors, std::span(transfer.vectors), "the vectors of probes");
        return volume;
    });
}

std::optional<CompressedVolume> read_compressed_volume(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<CompressedVolume> {
        const Json* extension = find_extension(contents, kVolumeExtension, kVolumeVersion);
        if (!extension || extension->contains("raw"))
            return std::nullopt;
        return read_words(contents, scene, *extension);
    });
}

void discard_volume(GltfDocument& document) {
    named(document, [](GltfContents& contents) { contents.remove_volume(); });
}

} // namespace prt

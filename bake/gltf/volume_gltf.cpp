// Reads and writes transfer of probes in glTF files: PRTKIT_transfer_volume of docs/format.md.

#include "bake/gltf/write_clustered_json.h"
#include "prt/gltf/transfer_gltf.h"
#include "runtime/load/allowance.h"
#include "runtime/load/probe_transfer.h"

#include <algorithm>
#include <string>

namespace prt {
namespace {

/// Writes four uint16 per brick.
Json write_bricks(GltfContents& contents, const VolumeGrid& grid) {
    std::vector<std::uint16_t> numbers;
    for (const VolumeBrick& brick : grid.bricks)
        for (const int n : {brick.position.x, brick.position.y, brick.position.z, brick.level})
            numbers.push_back(static_cast<std::uint16_t>(n));
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(std::span(numbers)))}};
}

Json write_visibility(GltfContents& contents, const std::vector<ProbeVisibility>& visibility) {
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(std::span(visibility)))}};
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
        ProbeLayout layout = read_probe_layout(contents, scene, *extension);
        const std::size_t probes = layout.visibility.size();
        BakedVolume volume{std::move(layout.grid), layout.order, std::move(layout.visibility), {}};
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
    return named(document,
                 [&](const GltfContents& contents) { return read_compressed_volume(contents, scene); });
}

void discard_volume(GltfDocument& document) {
    named(document, [](GltfContents& contents) { contents.remove_volume(); });
}

} // namespace prt

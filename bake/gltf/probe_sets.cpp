// Reads raw transfer of probes, and writes transfer of probes: docs/format.md.

#include "bake/gltf/read_raw_set.h"
#include "bake/gltf/write_set.h"
#include "prt/gltf/transfer_gltf.h"
#include "runtime/load/probe_transfer.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace prt {
namespace {

/// Writes four uint16 per brick.
Json write_bricks(GltfContents& contents, const VolumeGrid& grid) {
    std::vector<std::uint16_t> numbers;
    for (const VolumeBrick& brick : grid.bricks)
        for (const int n : {brick.position.x, brick.position.y, brick.position.z, brick.level})
            numbers.push_back(static_cast<std::uint16_t>(n));
    return write_view(contents, std::span<const std::uint16_t>(numbers));
}

void write_probes(GltfContents& contents, const Scene& scene, const ProbeLayout& probes, Json& set) {
    const glm::dvec3 origin = scene.world(probes.grid.origin);
    set.update({{"incidentOrder", probes.order},
                {"origin", {origin.x, origin.y, origin.z}},
                {"spacing", probes.grid.spacing},
                {"size", {probes.grid.size.x, probes.grid.size.y, probes.grid.size.z}},
                {"bricks", write_bricks(contents, probes.grid)},
                {"visibility", write_view(contents, std::span(probes.visibility))}});
}

} // namespace

void write_volume(GltfDocument& document, const Scene& scene, const BakedVolume& volume) {
    named(document, [&](GltfContents& contents) {
        contents.remove_volume();
        Json set = raw_set(ReceiverKind::probes, volume.baked);
        write_probes(contents, scene, volume, set);
        set["vectors"] = write_vectors(contents, volume.baked.transfer.vectors, volume.baked.storage);
        add_set(contents, std::move(set));
    });
}

void write_volume(GltfDocument& document, const Scene& scene, const CompressedVolume& volume) {
    named(document, [&](GltfContents& contents) {
        contents.remove_volume();
        Json set = write_clustered_set(contents, scene, ReceiverKind::probes, volume.compressed);
        write_probes(contents, scene, volume, set);
        set["words"] = write_view(contents, std::span(volume.compressed.transfer.receivers.weights));
        add_set(contents, std::move(set));
    });
}

std::optional<BakedVolume> read_volume(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<BakedVolume> {
        const Json* set = find_set(contents, ReceiverKind::probes, Coding::raw);
        if (!set)
            return std::nullopt;
        BakedVolume volume{read_probe_layout(contents, scene, *set), {}};
        volume.baked = read_raw_set(contents, *set, volume.visibility.size() * volume.coefficients());
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

// Reads compressed transfer of probes: docs/format.md.
#include "runtime/load/probe_transfer.h"

#include "runtime/core/support/counted.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/clustered_set.h"
#include "runtime/load/receiver_sets.h"
#include "runtime/load/transfer_json.h"

#include <cstring>
#include <string>

namespace prt {
namespace {

std::vector<std::byte> bytes_of(const GltfData& data, const Json& json) {
    const auto bytes = buffer_view_bytes(data.model, json.at("bufferView").get<int>());
    return {bytes.begin(), bytes.end()};
}

/// Converts an origin from the world to the frame of positions in `scene`.
glm::vec3 read_origin(const Scene& scene, const Json& json) {
    if (!json.is_array() || json.size() != 3)
        throw Error("the origin of the volume is not a list of three numbers");
    return glm::vec3(glm::dvec3(json[0].get<double>(), json[1].get<double>(), json[2].get<double>()) -
                     scene.origin);
}

VolumeGrid read_grid(const GltfData& data, const Scene& scene, const Json& json) {
    VolumeGrid grid;
    grid.origin = read_origin(scene, json.at("origin"));
    grid.spacing = json.at("spacing").get<float>();
    const Json& size = json.at("size");
    if (!size.is_array() || size.size() != 3)
        throw Error("the size of the volume is not a list of three numbers");
    for (int a = 0; a < 3; ++a)
        grid.size[a] =
            whole_number(size[static_cast<std::size_t>(a)], "the size of the volume", 1, kMaxBricksAlong);
    check_allowed(16.0 * grid.size.x * grid.size.y * grid.size.z, data.file_bytes, "its volume");
    const std::vector<std::byte> bytes = bytes_of(data, json.at("bricks"));
    if (bytes.size() % 8 != 0)
        throw Error("the size of the bricks of the volume is not a multiple of 8 bytes");
    std::vector<std::uint16_t> numbers(bytes.size() / 2);
    if (!bytes.empty())
        std::memcpy(numbers.data(), bytes.data(), bytes.size());
    for (std::size_t i = 0; i < numbers.size(); i += 4)
        grid.bricks.push_back({{numbers[i], numbers[i + 1], numbers[i + 2]}, numbers[i + 3]});
    check_grid(grid);
    check_allowed(static_cast<double>(grid.bricks.size()) * kBrickProbes * 64, data.file_bytes, "its volume");
    return grid;
}

std::vector<ProbeVisibility> read_visibility(const GltfData& data, const Json& json, std::size_t probes) {
    const std::vector<std::byte> bytes = bytes_of(data, json);
    std::vector<ProbeVisibility> visibility(probes);
    if (bytes.size() != probes * sizeof(ProbeVisibility))
        throw Error("the volume has " + std::to_string(probes) + " probes, but visibility distances for " +
                    std::to_string(bytes.size() / sizeof(ProbeVisibility)));
    if (!bytes.empty())
        std::memcpy(visibility.data(), bytes.data(), bytes.size());
    return visibility;
}

} // namespace

ProbeLayout read_probe_layout(const GltfData& data, const Scene& scene, const Json& set) {
    ProbeLayout layout;
    layout.order = whole_number(set.at("incidentOrder"), "incidentOrder", 2, kMaxIncidentOrder);
    layout.grid = read_grid(data, scene, set);
    layout.visibility = read_visibility(data, set.at("visibility"), probes_of(layout.grid).size());
    return layout;
}

std::optional<CompressedVolume> read_compressed_volume(const GltfData& data, const Scene& scene) {
    const Json* set = find_set(data, ReceiverKind::probes, Coding::clustered);
    if (!set)
        return std::nullopt;
    CompressedVolume volume{read_probe_layout(data, scene, *set), {}};
    volume.compressed = read_clustered_set(data, scene, *set, volume.coefficients());
    ClusteredReceivers& receivers = volume.compressed.transfer.receivers;
    receivers.weights = bytes_of(data, set->at("words"));
    const std::size_t probes = volume.visibility.size();
    if (receivers.weights.size() != probes * receivers.stride())
        throw Error("the size of the packed weights of the volume does not match its " +
                    counted(probes, "probe"));
    check_clusters(volume.compressed.transfer.bases.clusters(), 0, probes, "probe", receivers);
    return volume;
}

} // namespace prt

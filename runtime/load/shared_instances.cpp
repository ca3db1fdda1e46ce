// Reads instances that share transfer: PRTKIT_instances of docs/format.md.
#include "runtime/load/shared_instances.h"

#include "prt/core/error.h"
#include "runtime/domains/instance_lamps.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/even_placement.h"
#include "runtime/load/level_nodes.h"
#include "runtime/load/transfer_json.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>

namespace prt {
namespace {

glm::vec3 read_three(const Json& json) {
    if (json.size() != 3)
        throw Error("a box of its instances must have vectors of three numbers");
    return {json[0].get<float>(), json[1].get<float>(), json[2].get<float>()};
}

InstanceBox read_box(const Json& json) {
    const InstanceBox box{read_three(json.at("middle")), read_three(json.at("half"))};
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(box.middle[i]) <= 1e9f && box.half[i] > 0 && box.half[i] <= 1e9f))
            throw Error(
                "a box of its instances is invalid: its center must be within 1e9, its half size in 0..1e9");
    return box;
}

CodedFactors read_factors(const GltfData& data, const Json& json, std::size_t count) {
    constexpr float kMaxScale = 500; // times 127, covers all factors that `coded` accepts
    CodedFactors coded;
    const Json& scales = json.at("scales");
    if (scales.size() != kInstanceNumbers)
        throw Error("the factors of its instances must have " + std::to_string(kInstanceNumbers) + " scales");
    for (std::size_t j = 0; j < kInstanceNumbers; ++j) {
        coded.scales[j] = scales[j].get<float>();
        if (!(coded.scales[j] >= 0 && coded.scales[j] <= kMaxScale))
            throw Error("a scale of the factors of its instances is negative, not finite or too large");
    }
    const std::span<const std::byte> bytes = buffer_view_bytes(data.model, json.at("bufferView").get<int>());
    if (bytes.size() != count * kInstanceNumbers)
        throw Error("the factors of its instances have " + std::to_string(bytes.size()) +
                    " bytes, but must have " + std::to_string(count * kInstanceNumbers));
    for (const std::byte byte : bytes)
        coded.bytes.push_back(static_cast<std::int8_t>(byte));
    return coded;
}

/// Reads the light of `lamps` lamps at `count` instances.
std::vector<std::vector<InstanceLampLight>> read_lamps(const GltfData& data, const Json& json,
                                                       std::size_t count) {
    const auto lamps = static_cast<std::size_t>(whole_number(
        json.at("count"), "the number of lamps of its instances", 1, static_cast<int>(kMaxLamps)));
    const std::span<const std::byte> bytes = buffer_view_bytes(data.model, json.at("bufferView").get<int>());
    if (bytes.size() != count * lamps * kLampLightBytes)
        throw Error("the light of lamps at its instances has " + std::to_string(bytes.size()) +
                    " bytes, but must have " + std::to_string(count * lamps * kLampLightBytes));
    std::size_t drawn = count; // nodes can draw the same instance
    if (data.json.contains("nodes"))
        for (const Json& node : data.json["nodes"])
            drawn += extension_of(node, kInstancesExtension) ? 1 : 0;
    check_allowed(static_cast<double>(drawn * lamps * sizeof(InstanceLampLight)), data.file_bytes,
                  "the light of lamps at its instances");
    std::vector<std::vector<InstanceLampLight>> result(count);
    std::size_t at = 0;
    for (std::vector<InstanceLampLight>& of_instance : result)
        for (std::size_t l = 0; l < lamps; ++l, at += kLampLightBytes) {
            CodedLampLight light;
            std::memcpy(&light.scale, &bytes[at], sizeof light.scale);
            std::memcpy(light.bytes.data(), &bytes[at + sizeof light.scale], light.bytes.size());
            if (!(light.scale >= 0 && light.scale <= kMaxTransfer))
                throw Error(
                    "a scale of the light of lamps at its instances is negative, not finite or too large");
            of_instance.push_back(decoded(light));
        }
    return result;
}

} // namespace

StoredInstances read_stored_instances(const GltfData& data) {
    const Json* found = find_extension(data, kInstancesExtension, kInstancesVersion);
    if (!found)
        throw Error(std::string("has no extension ") + kInstancesExtension);
    const Json& extension = *found;
    const auto count = static_cast<std::size_t>(
        whole_number(extension.at("count"), "the number of instances", 1, kMaxSharedInstances));
    StoredInstances stored{decoded(read_factors(data, extension.at("factors"), count)), {}};
    if (extension.contains("lamps"))
        stored.lamps = read_lamps(data, extension["lamps"], count);
    if (extension.at("boxes").empty())
        throw Error("its instances have no boxes");
    for (const Json& box : extension.at("boxes"))
        stored.boxes.push_back(read_box(box));
    return stored;
}

FileInstance read_instance(const StoredInstances& stored, int node, const Json& extension,
                           const glm::dmat4& world) {
    const auto number = static_cast<std::size_t>(whole_number(extension.at("first"),
                                                              "\"first\" of node " + std::to_string(node), 0,
                                                              static_cast<int>(stored.factors.size()) - 1));
    const auto box =
        static_cast<std::size_t>(whole_number(extension.at("box"), "\"box\" of node " + std::to_string(node),
                                              0, static_cast<int>(stored.boxes.size()) - 1));
    const std::optional<EvenPlacement> placement = even_placement(world);
    if (!placement)
        throw Error(
            "node " + std::to_string(node) +
            " mirrors or non-uniformly scales an instance that shares its transfer; undo this, or bake "
            "with --instances own");
    FileInstance instance{node, number, {stored.factors[number], placement->rotation, stored.boxes[box]},
                          {},   {},     world};
    if (!stored.lamps.empty())
        instance.placed.lamps = stored.lamps[number];
    return instance;
}

std::vector<MeshInstance> mesh_instances(const GltfData& data) {
    const StoredInstances stored = read_stored_instances(data);
    std::vector<MeshInstance> instances;
    for (const NodeTransform& transform : level_nodes(data).finest) {
        const auto node = static_cast<std::size_t>(transform.node);
        const int mesh = data.model.nodes[node].mesh;
        const Json* extension = extension_of(data.json["nodes"][node], kInstancesExtension);
        if (extension && mesh >= 0 && transform.visible)
            instances.push_back({read_instance(stored, transform.node, *extension, transform.world), mesh});
    }
    std::ranges::sort(instances, {}, [](const MeshInstance& one) { return one.instance.node; });
    return instances;
}

void check_instance_lamps(const TransferLayout& layout, std::span<const FileInstance> instances) {
    for (const FileInstance& instance : instances)
        check_instance_lamps(layout, instance.placed);
}

std::vector<RelitInstance> relit_instances(std::span<const FileInstance> instances, const Scene& stored,
                                           const ClusteredTransfer& transfer, const glm::dvec3& seen_from) {
    std::vector<ConstantRows> of_arrays;
    for (const VertexArray& vertices : stored.vertex_arrays)
        of_arrays.push_back(rows_of(transfer, vertices.first_receiver, vertices.size()));
    std::vector<RelitInstance> computed;
    for (const FileInstance& instance : instances) {
        RelitInstance one{instance.placed, {}};
        one.placed.box.middle = glm::vec3(glm::dvec3(one.placed.box.middle) - (stored.origin - seen_from));
        for (const std::size_t array : instance.stored_arrays)
            one.rows = joined(one.rows, of_arrays[array]);
        computed.push_back(one);
    }
    return computed;
}

} // namespace prt

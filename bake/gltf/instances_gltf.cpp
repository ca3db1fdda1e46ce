// Reads and writes factors of instances in glTF files: PRTKIT_instances of docs/format.md.
#include "prt/gltf/transfer_gltf.h"

#include "bake/gltf/write_set.h"
#include "runtime/core/support/parallel.h"
#include "runtime/load/allowance.h"
#include "runtime/load/node_transforms.h"
#include "runtime/load/shared_instances.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace prt {
namespace {

Json three(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

bool same_vertices(const Scene& scene, std::size_t array, const Scene& stored, std::size_t other) {
    return scene.vertex_arrays[array].size() == stored.vertex_arrays[other].size();
}

int mesh_of_node(const GltfContents& contents, int node) {
    return contents.json["nodes"][static_cast<std::size_t>(node)]["mesh"].get<int>();
}

/// Returns the vertex array of `stored` with the transfer of each array of `scene`: [vertex arrays of scene].
/// Arrays that are not instances have the same order in both.
std::vector<std::size_t> stored_arrays(const GltfContents& contents, const Scene& scene, const Scene& stored,
                                       const std::map<int, FileInstance>& instances) {
    std::set<int> shared;
    for (const auto& [node, instance] : instances)
        shared.insert(mesh_of_node(contents, node));
    std::map<std::pair<int, int>, std::size_t> of_mesh; // (mesh, primitive) -> primitive of `stored`
    std::vector<std::size_t> plain;                     // primitives of `stored`
    for (std::size_t p = 0; p < stored.primitives.size(); ++p)
        if (const int mesh = stored.primitives[p].mesh; shared.contains(mesh))
            of_mesh[{mesh, stored.primitives[p].primitive}] = p;
        else
            plain.push_back(p);
    std::vector<std::size_t> result(scene.vertex_arrays.size());
    std::size_t next = 0;
    for (const Primitive& primitive : scene.primitives) {
        std::size_t from = stored.primitives.size();
        if (instances.contains(primitive.node)) {
            const auto found = of_mesh.find({mesh_of_node(contents, primitive.node), primitive.primitive});
            from = found == of_mesh.end() ? from : found->second;
        } else if (next < plain.size()) {
            from = plain[next++];
        }
        if (from >= stored.primitives.size() ||
            !same_vertices(scene, primitive.vertices, stored, stored.primitives[from].vertices))
            throw Error(primitive_name(primitive) +
                        " does not have the vertices for which its transfer is stored");
        result[primitive.vertices] = stored.primitives[from].vertices;
    }
    return result;
}

std::map<int, FileInstance> instances_of(const GltfContents& contents, const Scene& scene) {
    const StoredInstances factors = read_stored_instances(contents);
    std::map<int, FileInstance> instances;
    std::map<int, glm::dmat4> world;
    for (const NodeTransform& transform : world_transforms(contents.model))
        world[transform.node] = transform.world;
    for (const Primitive& primitive : scene.primitives) {
        const Json& node = contents.json["nodes"][static_cast<std::size_t>(primitive.node)];
        if (const Json* extension = extension_of(node, kInstancesExtension))
            if (!instances.contains(primitive.node))
                instances.emplace(primitive.node, read_instance(factors, primitive.node, *extension,
                                                                world.at(primitive.node)));
    }
    return instances;
}

/// Modes of a mesh for instances with the same up direction in their frame.
struct MeshModes {
    std::size_t array;
    glm::dvec3 up;
    SharedTransfer shared;
    std::vector<glm::vec3> positions;
};

class Expansion {
public:
    Expansion(const Scene& stored, const Transfer& transfer, int threads)
        : stored_(stored), transfer_(transfer), threads_(threads) {}

    void write(const PlacedInstance& placed, std::size_t array, std::span<float> to) {
        const MeshModes& modes = modes_of(array, glm::transpose(placed.rotation) * glm::dvec3(0, 1, 0));
        expand_instance(modes.shared, transfer_.layout, placed, modes.positions, to);
    }
    /// Prepares the modes that `write` needs, so that threads can share them.
    void prepare(const PlacedInstance& placed, std::size_t array) {
        modes_of(array, glm::transpose(placed.rotation) * glm::dvec3(0, 1, 0));
    }
    std::span<const float> vectors_of(std::size_t array) const {
        const VertexArray& vertices = stored_.vertex_arrays[array];
        return std::span(transfer_.vectors)
            .subspan(vertices.first_receiver * transfer_.dimension(),
                     vertices.size() * transfer_.dimension());
    }

private:
    const MeshModes& modes_of(std::size_t array, const glm::dvec3& up) {
        constexpr double kSame = 1e-5;
        for (const MeshModes& modes : modes_)
            if (modes.array == array && glm::distance(modes.up, up) < kSame)
                return modes;
        const std::span<const float> vectors = vectors_of(array);
        std::vector<glm::vec3> positions;
        for (const glm::vec3& position : stored_.vertex_arrays[array].positions)
            positions.emplace_back(stored_.world(position));
        modes_.push_back({array, up,
                          SharedTransfer({transfer_.layout, {vectors.begin(), vectors.end()}},
                                         glm::normalize(up), threads_),
                          std::move(positions)});
        return modes_.back();
    }

    const Scene& stored_;
    const Transfer& transfer_;
    int threads_;
    std::vector<MeshModes> modes_;
};

/// Writes the light of lamps at instances.
Json write_lamps(GltfContents& contents, const std::vector<std::vector<InstanceLampLight>>& lamps) {
    std::vector<std::byte> bytes;
    const auto add = [&](const auto& value) {
        const auto view = std::as_bytes(std::span(&value, 1));
        bytes.insert(bytes.end(), view.begin(), view.end());
    };
    for (const std::vector<InstanceLampLight>& of_instance : lamps)
        for (const InstanceLampLight& light : of_instance) {
            const CodedLampLight of_file = coded(light);
            add(of_file.scale);
            add(of_file.bytes);
        }
    return {{"count", lamps.front().size()}, {"bufferView", contents.add_buffer_view(bytes)}};
}

} // namespace

void write_instances(GltfDocument& document, const StoredInstances& instances) {
    named(document, [&](GltfContents& contents) {
        const CodedFactors factors = coded(instances.factors);
        Json boxes = Json::array();
        for (const InstanceBox& box : instances.boxes)
            boxes.push_back({{"middle", three(box.middle)}, {"half", three(box.half)}});
        const std::size_t view = contents.add_buffer_view(std::as_bytes(std::span(factors.bytes)));
        extensions_of(contents.json)[kInstancesExtension] = {
            {"version", kInstancesVersion},
            {"count", instances.factors.size()},
            {"boxes", std::move(boxes)},
            {"factors", {{"bufferView", view}, {"scales", factors.scales}}}};
        if (!instances.lamps.empty()) {
            Json lamps = write_lamps(contents, instances.lamps);
            contents.json["extensions"][kInstancesExtension]["lamps"] = std::move(lamps);
        }
    });
}

bool holds_instances(const GltfDocument& document) {
    return extension_of(document.contents().json, kInstancesExtension) != nullptr;
}

bool shares_instances(const GltfDocument& document) {
    return document.contents().separate.empty() && holds_instances(document);
}

std::vector<FileInstance> read_instances(const GltfDocument& document, const Scene& scene,
                                         const Scene& stored) {
    return named(document, [&](const GltfContents& contents) {
        std::map<int, FileInstance> instances = instances_of(contents, scene);
        const std::vector<std::size_t> from = stored_arrays(contents, scene, stored, instances);
        std::vector<FileInstance> result;
        for (const Primitive& primitive : scene.primitives) {
            const auto found = instances.find(primitive.node);
            if (found == instances.end())
                continue;
            FileInstance& instance = found->second;
            if (std::ranges::find(instance.arrays, primitive.vertices) != instance.arrays.end())
                continue;
            instance.arrays.push_back(primitive.vertices);
            instance.stored_arrays.push_back(from[primitive.vertices]);
        }
        for (auto& [node, instance] : instances)
            result.push_back(std::move(instance));
        return result;
    });
}

Transfer expanded(const GltfDocument& document, const Scene& scene, const Scene& stored,
                  const Transfer& transfer, int threads) {
    const std::vector<FileInstance> instances = read_instances(document, scene, stored);
    return named(document, [&](const GltfContents& contents) {
        const std::size_t dimension = transfer.dimension();
        // Sixteen times the usual limit for generated data, because a file with few stored vectors can expand
        // to many.
        check_allowed(static_cast<double>(scene.receivers() * dimension * sizeof(float)) / 16,
                      contents.file_bytes, "the transfer of its instances");
        std::map<int, FileInstance> by_node;
        for (const FileInstance& instance : instances)
            by_node.emplace(instance.node, instance);
        const std::vector<std::size_t> from = stored_arrays(contents, scene, stored, by_node);
        Transfer all = zero_transfer(transfer.layout, scene.receivers());
        const auto vectors = [&](std::size_t array) {
            const VertexArray& vertices = scene.vertex_arrays[array];
            return std::span(all.vectors)
                .subspan(vertices.first_receiver * dimension, vertices.size() * dimension);
        };
        Expansion expansion(stored, transfer, threads);
        std::vector<const FileInstance*> owner(scene.vertex_arrays.size(), nullptr);
        for (const FileInstance& instance : instances)
            for (const std::size_t array : instance.arrays) {
                owner[array] = &instance;
                expansion.prepare(instance.placed, from[array]);
            }
        parallel_for(scene.vertex_arrays.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t array = begin; array < end; ++array) {
                if (owner[array])
                    expansion.write(owner[array]->placed, from[array], vectors(array));
                else
                    std::ranges::copy(expansion.vectors_of(from[array]), vectors(array).begin());
            }
        });
        return all;
    });
}

} // namespace prt

// Converts nodes that were created for instances when the file was read back to instances of a shared mesh.
#include "prt/gltf/transfer_gltf.h"

#include "bake/gltf/contents.h"
#include "bake/gltf/encode_glb.h"
#include "runtime/load/accessor.h"
#include "runtime/load/shared_instances.h"

#include <algorithm>
#include <cstring>
#include <map>

namespace prt {
namespace {

/// Index of the instance of a node, and of its mesh among the shared ones.
struct Numbered {
    std::size_t number, mesh;
};

/// Adds an accessor like `reference` with the elements of instances `kept`.
std::size_t selected_accessor(GltfContents& contents, const Json& reference,
                              const std::vector<std::size_t>& kept) {
    const auto index = reference.get<int>();
    const std::vector<std::byte> elements = read_elements(contents.model, index);
    Json accessor = contents.json["accessors"].at(static_cast<std::size_t>(index));
    const std::size_t size = elements.size() / std::max<std::size_t>(1, accessor["count"].get<std::size_t>());
    std::vector<std::byte> picked(kept.size() * size);
    for (std::size_t i = 0; i < kept.size(); ++i)
        std::memcpy(&picked[i * size], &elements[kept[i] * size], size);
    for (const char* key : {"sparse", "byteOffset", "min", "max"})
        accessor.erase(key);
    accessor["count"] = kept.size();
    accessor["bufferView"] = contents.add_buffer_view(picked);
    return contents.add_accessor(std::move(accessor));
}

class MeshSharing {
public:
    MeshSharing(GltfContents& contents, const std::vector<SharedMesh>& meshes) : contents_(contents) {
        std::size_t number = 0;
        for (std::size_t m = 0; m < meshes.size(); ++m)
            for (const MeshPlacement& placement : meshes[m].placements)
                numbered_[static_cast<std::size_t>(placement.node)] = {number++, m};
    }

    /// Returns the new index of each node; -1 if it became an instance of another.
    std::vector<int> share(std::size_t meshes) {
        std::vector<bool> removed(nodes().size());
        for (const ExpandedNode& expanded : contents_.expanded)
            join_instances(expanded, removed);
        for (const auto& [node, numbered] : numbered_)
            if (!removed[node])
                extensions_of(nodes()[node])[kInstancesExtension] = {{"first", numbered.number},
                                                                     {"box", numbered.mesh}};
        Json boxes = Json::array();
        for (std::size_t m = 0; m < meshes; ++m)
            boxes.push_back({{"middle", {0, 0, 0}}, {"half", {1, 1, 1}}});
        extensions_of(contents_.json)[kInstancesExtension] = {
            {"version", kInstancesVersion}, {"count", numbered_.size()}, {"boxes", boxes}};
        contents_.use_extension(kInstancesExtension);
        return remove(removed);
    }

private:
    /// Looked up each time, because adding members moves the array.
    Json& nodes() { return contents_.json["nodes"]; }

    /// Converts the sharing nodes of `expanded` back to instances.
    void join_instances(const ExpandedNode& expanded, std::vector<bool>& removed) {
        std::vector<std::size_t> kept;
        for (std::size_t i = 0; i < expanded.count; ++i)
            if (numbered_.contains(expanded.first + i))
                kept.push_back(i);
        if (kept.empty())
            return;
        const Numbered first = numbered_.at(expanded.first + kept.front());
        Json extension = expanded.extension;
        if (kept.size() < expanded.count)
            for (Json& accessor : extension["attributes"])
                accessor = selected_accessor(contents_, accessor, kept);
        nodes()[expanded.node]["mesh"] = Json(nodes()[expanded.first + kept.front()]["mesh"]);
        Json& extensions = extensions_of(nodes()[expanded.node]);
        extensions[kInstancingExtension] = std::move(extension);
        extensions[kInstancesExtension] = {{"first", first.number}, {"box", first.mesh}};
        contents_.use_extension(kInstancingExtension);
        for (const std::size_t i : kept)
            removed[expanded.first + i] = true;
    }

    std::vector<int> remove(const std::vector<bool>& removed) {
        Json kept = Json::array();
        std::vector<int> node_of;
        for (std::size_t n = 0; n < removed.size(); ++n) {
            node_of.push_back(removed[n] ? -1 : static_cast<int>(kept.size()));
            if (!removed[n])
                kept.push_back(std::move(nodes()[n]));
        }
        for (Json& node : kept)
            if (node.contains("children")) {
                Json children = Json::array();
                for (const Json& child : node["children"])
                    if (const int now = node_of[child.get<std::size_t>()]; now >= 0)
                        children.push_back(now);
                if (children.empty())
                    node.erase("children");
                else
                    node["children"] = std::move(children);
            }
        nodes() = std::move(kept);
        return node_of;
    }

    GltfContents& contents_;
    std::map<std::size_t, Numbered> numbered_; ///< by node
};

} // namespace

SharedDocument with_shared_meshes(const GltfDocument& document, const std::vector<SharedMesh>& meshes) {
    const GltfContents& from = document.contents();
    GltfContents copy = from;
    copy.remove_transfer();
    const std::vector<int> node_of = MeshSharing(copy, meshes).share(meshes.size());
    const GltfDocument written(std::make_unique<GltfContents>(std::move(copy)));
    GltfDocument separate = parse_gltf(encode_glb(written), from.path,
                                       {.instancing = Instancing::separate, .scene_limit = from.scene_limit});
    separate.contents().notices = from.notices;
    std::vector<int> mesh_nodes(meshes.size(), -1);
    for (const DeduplicatedMesh& mesh : separate.contents().separate) {
        const Json& drawer = separate.contents().json["nodes"][mesh.drawers.front()];
        mesh_nodes[drawer["extensions"][kInstancesExtension]["box"].get<std::size_t>()] =
            static_cast<int>(mesh.stand_in);
    }
    return {std::move(separate), std::move(mesh_nodes), node_of};
}

} // namespace prt

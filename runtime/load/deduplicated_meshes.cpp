// Moves meshes whose instances share transfer to proxy nodes, which draw each mesh once, and back.
#include "runtime/load/deduplicated_meshes.h"

#include "prt/core/error.h"
#include "runtime/load/extensions.h"

#include <map>
#include <string>
#include <utility>

namespace prt {
namespace {

/// Adds a root to the extracted scene, in the JSON and in the model.
void add_root(GltfData& data, std::size_t node) {
    if (data.model.scenes.empty())
        return; // all nodes without parents are roots
    const std::size_t scene =
        data.model.defaultScene >= 0 ? static_cast<std::size_t>(data.model.defaultScene) : 0;
    member(data.json["scenes"].at(scene), "nodes", Json::value_t::array).push_back(node);
    data.model.scenes.at(scene).push_back(static_cast<int>(node));
}

} // namespace

void deduplicate_meshes(GltfData& data) {
    if (!data.json.contains("nodes"))
        return;
    Json& nodes = data.json["nodes"];
    std::map<std::size_t, std::size_t> of_mesh; // index in `separate`
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (!extension_of(nodes[n], kInstancesExtension))
            continue;
        if (!nodes[n].contains("mesh"))
            throw Error("node " + std::to_string(n) + " has " + kInstancesExtension + ", but no mesh");
        const auto mesh = nodes[n]["mesh"].get<std::size_t>();
        const auto [found, is_new] = of_mesh.try_emplace(mesh, data.separate.size());
        if (is_new)
            data.separate.push_back({mesh, {}}); // stores the mesh until its proxy node has an index
        data.separate[found->second].drawers.push_back(n);
        nodes[n].erase("mesh");
        data.model.nodes[n].mesh = -1;
    }
    for (DeduplicatedMesh& separate : data.separate) {
        const std::size_t mesh = std::exchange(separate.stand_in, nodes.size());
        nodes.push_back({{"mesh", mesh}});
        data.model.nodes.emplace_back().mesh = static_cast<int>(mesh);
        add_root(data, separate.stand_in);
    }
}

void put_meshes_back(const std::vector<DeduplicatedMesh>& separate, Json& json) {
    for (auto deduplicated_mesh = separate.rbegin(); deduplicated_mesh != separate.rend();
         ++deduplicated_mesh) {
        const Json mesh = json["nodes"][deduplicated_mesh->stand_in]["mesh"];
        for (const std::size_t drawer : deduplicated_mesh->drawers)
            json["nodes"][drawer]["mesh"] = mesh;
        json["nodes"].erase(deduplicated_mesh->stand_in); // the last node
        if (!json.contains("scenes"))
            continue;
        for (Json& scene : json["scenes"])
            if (scene.contains("nodes") && !scene["nodes"].empty() &&
                scene["nodes"].back() == deduplicated_mesh->stand_in)
                scene["nodes"].erase(scene["nodes"].size() - 1);
    }
}

} // namespace prt

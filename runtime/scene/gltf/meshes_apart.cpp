// Moves meshes whose instances share transfer to stand-in nodes, and back.
#include "gltf/meshes_apart.h"

#include "prt/support/error.h"

#include <map>
#include <string>
#include <utility>

namespace prt {
namespace {

/// Adds a root to the extracted scene, in the JSON and in the model.
void add_root(GltfContents& contents, std::size_t node) {
    if (contents.model.scenes.empty())
        return; // all nodes without parents are roots
    const std::size_t scene =
        contents.model.defaultScene >= 0 ? static_cast<std::size_t>(contents.model.defaultScene) : 0;
    member(contents.json["scenes"].at(scene), "nodes", Json::value_t::array).push_back(node);
    contents.model.scenes.at(scene).nodes.push_back(static_cast<int>(node));
}

} // namespace

void set_meshes_apart(GltfContents& contents) {
    if (!contents.json.contains("nodes"))
        return;
    Json& nodes = contents.json["nodes"];
    std::map<std::size_t, std::size_t> of_mesh; // index in `apart`
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (!extension_of(nodes[n], kInstancesExtension))
            continue;
        if (!nodes[n].contains("mesh"))
            throw Error("node " + std::to_string(n) + " has " + kInstancesExtension + " and no mesh");
        const auto mesh = nodes[n]["mesh"].get<std::size_t>();
        const auto [found, is_new] = of_mesh.try_emplace(mesh, contents.apart.size());
        if (is_new)
            contents.apart.push_back({mesh, {}}); // holds the mesh until the stand-in has an index
        contents.apart[found->second].drawers.push_back(n);
        nodes[n].erase("mesh");
        contents.model.nodes[n].mesh = -1;
    }
    for (MeshApart& apart : contents.apart) {
        const std::size_t mesh = std::exchange(apart.stand_in, nodes.size());
        nodes.push_back({{"mesh", mesh}});
        contents.model.nodes.emplace_back().mesh = static_cast<int>(mesh);
        add_root(contents, apart.stand_in);
    }
}

void put_meshes_back(const std::vector<MeshApart>& apart, Json& json) {
    for (auto mesh_apart = apart.rbegin(); mesh_apart != apart.rend(); ++mesh_apart) {
        const Json mesh = json["nodes"][mesh_apart->stand_in]["mesh"];
        for (const std::size_t drawer : mesh_apart->drawers)
            json["nodes"][drawer]["mesh"] = mesh;
        json["nodes"].erase(mesh_apart->stand_in); // the last node
        if (!json.contains("scenes"))
            continue;
        for (Json& scene : json["scenes"])
            if (scene.contains("nodes") && !scene["nodes"].empty() &&
                scene["nodes"].back() == mesh_apart->stand_in)
                scene["nodes"].erase(scene["nodes"].size() - 1);
    }
}

} // namespace prt

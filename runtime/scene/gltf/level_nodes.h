#pragma once

// Which nodes of a file are coarser levels of detail of others, and where they stand.

#include "gltf/contents.h"
#include "gltf/node_transforms.h"

#include <string>
#include <vector>

namespace prt {

/// Levels of one node of the scene.
struct NodeLevels {
    struct Level {
        int number; ///< from 1 on
        int node;
        std::vector<NodeTransform> nodes; ///< itself and all below it but levels of others
    };
    int node = 0;
    bool by_name = false;
    std::vector<int> finest; ///< itself and all below it but coarser levels
    std::vector<Level> coarser;
};

/// The nodes of a scene, levels apart.
struct LevelNodes {
    std::vector<NodeTransform> finest; ///< as `world_transforms`, without coarser levels and what is below
    std::vector<NodeLevels> levels;
    std::vector<glm::dmat4> world; ///< [nodes of the file]; the identity for those that stand nowhere
    std::size_t left_out = 0;      ///< coarser levels that the scene would draw
    std::vector<std::string> notices;
};

/// Throws `Error` where the hierarchy is no tree, and for MSFT_lod that names nodes which are not there,
/// levels of levels, nodes above the level, and a node twice.
LevelNodes level_nodes(const GltfContents& contents);

/// "node 3 'Rock'"
std::string node_name(const tinygltf::Model& model, int node);

} // namespace prt

#pragma once

// Detection of nodes that are coarser levels of detail, and their transforms.

#include "runtime/load/gltf_data.h"
#include "runtime/load/node_transforms.h"

#include <string>
#include <vector>

namespace prt {

/// Levels of one node of the scene.
struct NodeLevels {
    struct Level {
        int number; ///< from 1 on
        int node;
        std::vector<NodeTransform> nodes; ///< the node and its descendants, except levels of other nodes
    };
    int node = 0;
    bool by_name = false;
    std::vector<int> finest; ///< the node and its descendants, except coarser levels
    std::vector<Level> coarser;
};

/// The nodes of a scene, with levels separated.
struct LevelNodes {
    std::vector<NodeTransform> finest; ///< result of `world_transforms` without coarser levels and their
                                       ///< descendants
    std::vector<NodeLevels> levels;
    std::vector<glm::dmat4> world; ///< [nodes of the file]; the identity for nodes without a position
    /// Coarser levels outside the scene, with their descendants; parents before children.
    std::vector<NodeTree::Entry> outside;
    std::size_t left_out = 0; ///< coarser levels that are part of the scene
    std::vector<std::string> notices;
};

/// Finds levels. Throws `Error` if the hierarchy is not a tree, and if MSFT_lod references missing nodes,
/// levels of levels, ancestors of the level, or a node twice.
LevelNodes level_nodes(const GltfData& data);

/// Returns "node 3 'Rock'".
std::string node_name(const GltfModel& model, int node);

} // namespace prt

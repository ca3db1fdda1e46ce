#pragma once

// Levels of detail of glTF files: coarser nodes that replace others when these are small in the picture, by
// MSFT_lod or by names (docs/format.md). Experimental.

#include "prt/gltf.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// A node that replaces another, with all its descendants.
struct CoarserLevel {
    int level = 1; ///< counted from 1; level 0 is the node itself
    int node = 0;
    std::string name;                    ///< "node 3 'Rock_LOD1'"
    std::vector<std::size_t> primitives; ///< primitives of the scene; at least one
};

/// A node of the scene with coarser levels.
struct LeveledNode {
    int node = 0;
    std::string name;
    bool by_name = false;            ///< true: defined by names, not by MSFT_lod
    std::vector<std::size_t> finest; ///< primitives of level 0; at least one
    std::vector<CoarserLevel> coarser;
};

/// The result of `extract_scene`, unchanged, followed by the coarser levels, each at its position in the
/// scene. A level outside the scene is placed at the position of its level 0.
struct LeveledScene {
    Scene scene;
    std::size_t finest_receivers = 0, finest_primitives = 0; ///< counts of `extract_scene`
    std::vector<LeveledNode> nodes;                          ///< in the order of the scene
    std::vector<std::string> notices; ///< levels that are ignored and the reason, one line each

    std::size_t deepest() const; ///< maximum level; 0 if there are no levels
};

/// Returns quickly whether nodes of the scene have coarser levels.
bool has_levels(const GltfDocument& document);

/// Extracts the scene with its levels. Throws `Error` as `extract_scene`, which also rejects contradictory
/// levels.
LeveledScene extract_levels(const GltfDocument& document);

/// Returns whether coarser levels of the document have transfer; `scene` was extracted from it.
bool levels_have_transfer(const GltfDocument& document, const LeveledScene& scene);

/// Returns the number of vertices of some primitives.
std::size_t vertices_of(const Scene& scene, std::span<const std::size_t> primitives);

/// Returns areas of the receivers of level `level` of all nodes, zero for others: [receivers of the scene].
/// For level 0: areas of all receivers of `extract_scene`.
std::vector<float> areas_of_level(const LeveledScene& scene, std::size_t level);

} // namespace prt

#pragma once

// Levels of detail of glTF files: coarser nodes that replace others when these are small in the picture, by
// MSFT_lod or by names (docs/format.md). Experimental.

#include "prt/gltf.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// A node tree that replaces that of a `LeveledNode`.
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

/// A scene with its coarser levels: the result of `extract_scene`, unchanged, followed by all coarser levels,
/// each at its position in the scene. A level outside the scene gets the position of its level 0.
struct LeveledScene {
    Scene scene;
    std::size_t finest_receivers = 0, finest_primitives = 0; ///< counts of `extract_scene`
    std::vector<LeveledNode> nodes;                          ///< by MSFT_lod, then by names
    std::vector<std::string> notices; ///< levels that are ignored and the reason, one line each

    std::size_t deepest() const; ///< maximum level; 0 if there are no levels
};

/// Returns quickly whether nodes of the scene have coarser levels.
bool has_levels(const GltfDocument& document);

/// Returns the scene with its coarser levels. Throws the errors of `extract_scene`, which also rejects
/// contradictory levels.
LeveledScene extract_levels(const GltfDocument& document);

/// Returns whether coarser levels of the document have transfer; `scene` was extracted from it.
bool levels_have_transfer(const GltfDocument& document, const LeveledScene& scene);

/// Returns the number of vertices of `primitives`, which are indices into Scene::primitives.
std::size_t vertices_of(const Scene& scene, std::span<const std::size_t> primitives);

/// Returns areas, [receivers of the scene]: those of the receivers of level `level` of all nodes, and zero
/// for all other receivers. Level 0 includes all receivers of `extract_scene`.
std::vector<float> areas_of_level(const LeveledScene& scene, std::size_t level);

} // namespace prt

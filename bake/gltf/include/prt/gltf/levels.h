#pragma once

// Levels of detail of glTF files: coarser nodes that replace others when these are small in the picture, by
// MSFT_lod or by names (docs/format.md). Experimental.

#include "prt/gltf/gltf.h"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// A coarser level of detail of a `LeveledNode`. If the object is small in the picture, the node of the level
/// and its descendants replace the `LeveledNode` and its descendants.
struct CoarserLevel {
    int level = 1;    ///< 1 for the finest coarser level, 2 for the next, and so on; ignored levels count
    int node = 0;     ///< index in the nodes of the GltfDocument
    std::string name; ///< for messages: "node 3 'Rock_LOD1'"; "node 3" if it has no name
    std::vector<std::size_t> primitives; ///< indices into the primitives of LeveledScene::scene; at least one
};

/// A node of the scene that has coarser levels. The node itself, with its descendants, is level 0.
struct LeveledNode {
    int node = 0;                      ///< index in the nodes of the GltfDocument
    std::string name;                  ///< for messages: "node 2 'Rock_LOD0'"; "node 2" if it has no name
    bool by_name = false;              ///< true: node names define the levels; false: MSFT_lod does
    std::vector<std::size_t> finest;   ///< level 0: indices into the primitives of LeveledScene::scene; at
                                       ///< least one
    std::vector<CoarserLevel> coarser; ///< in ascending order of `level`; at least one
};

/// A scene with the coarser levels of its nodes.
struct LeveledScene {
    /// The scene of `extract_scene`, with the same origin; the vertex arrays and primitives of all coarser
    /// levels are appended. A level that is not in the glTF scene counts as a child of the parent of its
    /// level 0.
    Scene scene;
    std::size_t finest_receivers = 0, ///< number of receivers of `extract_scene`, which come first in `scene`
        finest_primitives = 0;      ///< number of primitives of `extract_scene`, which come first in `scene`
    std::vector<LeveledNode> nodes; ///< nodes with levels by MSFT_lod, then nodes with levels by names
    /// Messages about levels that are ignored, with the reason, one line each.
    std::vector<std::string> notices;

    /// Returns the maximum of CoarserLevel::level over all `nodes`; 0 if `nodes` is empty.
    std::size_t deepest() const;
};

/// Returns whether MSFT_lod or node names define coarser levels for visible nodes of the scene. Does not read
/// vertices; therefore the result is also true for levels without triangles, which `extract_levels` ignores.
/// Throws `Error` if MSFT_lod or the hierarchy of nodes is invalid.
bool has_levels(const GltfDocument& document);

/// Returns the scene of `document` with its coarser levels. Throws the errors of `extract_scene`, also for
/// vertices and triangles of coarser levels.
LeveledScene extract_levels(const GltfDocument& document);

/// Removes the levels of `nodes` that have no primitive for which `keep` is true, and nodes without levels.
/// `nodes` are those of a LeveledScene whose scene is `scene`.
void keep_levels(std::vector<LeveledNode>& nodes, const Scene& scene,
                 const std::function<bool(const Primitive&)>& keep);

/// Returns whether the file has raw or compressed transfer of vertices for at least one primitive of a
/// coarser level. `scene` was extracted from `document` by `extract_levels`.
bool levels_have_transfer(const GltfDocument& document, const LeveledScene& scene);

/// Returns the number of vertices of the vertex arrays that `primitives` use; an array that several
/// primitives share counts once. `primitives` are indices into Scene::primitives.
std::size_t vertices_of(const Scene& scene, std::span<const std::size_t> primitives);

/// Returns areas in m², [receivers of `scene.scene`]: `receiver_areas` for receivers that belong to level
/// `level` of any node, and zero for all other receivers. Level 0 is all receivers of `extract_scene`,
/// including those of nodes without levels.
std::vector<float> areas_of_level(const LeveledScene& scene, std::size_t level);

} // namespace prt

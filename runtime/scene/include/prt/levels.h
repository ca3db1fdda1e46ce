#pragma once

// Levels of detail of glTF files: nodes that stand in for others where these are small in the picture, by
// MSFT_lod or by names (docs/format.md). Experimental.

#include "prt/gltf.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// A node that stands in for another, with all below it.
struct CoarserLevel {
    int level = 1; ///< counted from 1; level 0 is the node itself
    int node = 0;
    std::string name;                    ///< "node 3 'Rock_LOD1'"
    std::vector<std::size_t> primitives; ///< of the scene; there is one at least
};

/// A node of the scene that coarser ones stand in for.
struct LeveledNode {
    int node = 0;
    std::string name;
    bool by_name = false;            ///< names say so, not MSFT_lod
    std::vector<std::size_t> finest; ///< primitives of level 0; there is one at least
    std::vector<CoarserLevel> coarser;
};

/// What `extract_scene` gives, bit by bit, and behind it the coarser levels, each where it stands in the
/// scene; one that is in no scene stands beside its level 0.
struct LeveledScene {
    Scene scene;
    std::size_t finest_receivers = 0, finest_primitives = 0; ///< of `extract_scene`
    std::vector<LeveledNode> nodes;                          ///< in the order of the scene
    std::vector<std::string> notices; ///< of levels that are left out, and why, a line each

    std::size_t deepest() const; ///< the largest level, 0: there is none
};

/// Whether nodes of the scene have coarser levels, and quick.
bool has_levels(const GltfDocument& document);

/// Throws `Error` as `extract_scene`, which refuses levels that contradict one another, too.
LeveledScene extract_levels(const GltfDocument& document);

/// Whether coarser levels of the document have transfer; `scene` was extracted from it.
bool levels_have_transfer(const GltfDocument& document, const LeveledScene& scene);

/// How many vertices some primitives have.
std::size_t vertices_of(const Scene& scene, std::span<const std::size_t> primitives);

/// Areas of the receivers of level `level` of all nodes, zero for others: [receivers of the scene]. Level 0:
/// of all that `extract_scene` gives.
std::vector<float> areas_of_level(const LeveledScene& scene, std::size_t level);

} // namespace prt

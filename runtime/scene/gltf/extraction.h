#pragma once

// Extraction of a scene from a document, and of its vertices before transformation.

#include "prt/gltf/animation.h"
#include "runtime/scene/gltf/contents.h"
#include "runtime/scene/gltf/level_nodes.h"

#include <map>
#include <vector>

namespace prt {

/// Data to keep: the movement of vertices requires the memory of the scene again.
enum class Keep { scene, moving };

struct Extraction {
    Scene scene;
    /// [vertex arrays], for vertices of the file; VertexArray::source maps vertices that flat normals split.
    /// Normals are empty if the file has none.
    std::vector<MovingVertices> moving;
    std::map<int, Skin> skins; ///< skins that vertices use
};

Extraction extract(const GltfContents& contents, Keep keep);

/// The scene, followed by the coarser levels of its nodes.
struct LeveledExtraction {
    Scene scene;
    std::size_t finest_primitives = 0;
    std::vector<NodeLevels> levels;
    std::vector<std::string> notices; ///< about levels
};
LeveledExtraction extract_leveled(const GltfContents& contents);

} // namespace prt

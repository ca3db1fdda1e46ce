#pragma once

// A scene taken out of a document, and what its vertices were before they were placed.

#include "gltf/contents.h"
#include "gltf/level_nodes.h"
#include "prt/animation.h"

#include <map>
#include <vector>

namespace prt {

/// What is kept beside the scene: how its vertices move takes as much memory again.
enum class Keep { scene, moving };

struct Extraction {
    Scene scene;
    /// [vertex arrays], of vertices of the file: where flat normals split some, VertexArray::source has them.
    /// Normals are empty where the file has none.
    std::vector<MovingVertices> moving;
    std::map<int, Skin> skins; ///< that vertices hang on
};

Extraction extract(const GltfContents& contents, Keep keep);

/// The scene, then the coarser levels of its nodes.
struct LeveledExtraction {
    Scene scene;
    std::size_t finest_primitives = 0;
    std::vector<NodeLevels> levels;
    std::vector<std::string> notices; ///< of levels
};
LeveledExtraction extract_leveled(const GltfContents& contents);

} // namespace prt

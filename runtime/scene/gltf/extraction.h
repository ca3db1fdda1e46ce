#pragma once

// A scene taken out of a document, and what its vertices were before they were placed.

#include "gltf/contents.h"
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

} // namespace prt

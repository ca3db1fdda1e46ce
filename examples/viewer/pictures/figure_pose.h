#pragma once

// Pose and position of the moving figure in a frame.

#include "prt/load/scene.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <vector>

namespace viewer {

/// Matrices of the vertex arrays of a moving scene: [vertex arrays][matrices], as returned by
/// prt::AnimatedScene::matrices, transformed into the open scene.
using Palettes = std::vector<std::vector<glm::mat4>>;

/// The figure in a frame: all data that lighting and shading by the figure need.
struct FigurePose {
    std::vector<glm::dmat4> nodes; ///< world matrices of the nodes of its file, including joints
    glm::dmat4 placement{1};   ///< transform from the world space of its file to positions of the open scene
                               ///< (Scene::origin)
    Palettes palettes;         ///< palettes of its vertex arrays, including `placement`
    prt::Bounds box{};         ///< bounding box in the scene
    std::uint64_t version = 0; ///< changes when the figure moves; 0: there is no figure

    /// Returns the matrix of a node in the scene.
    glm::dmat4 node(std::size_t index) const { return placement * nodes[index]; }
};

} // namespace viewer

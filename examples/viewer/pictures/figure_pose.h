#pragma once

// Where what moves is in a frame.

#include "prt/scene.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <vector>

namespace viewer {

/// What the vertex arrays of a scene that moves are multiplied by: [vertex arrays][matrices], as
/// prt::AnimatedScene::matrices gives them, placed in the scene that is open.
using Palettes = std::vector<std::vector<glm::mat4>>;

/// The figure in a frame: all that lights or shades others by it needs of it.
struct FigurePose {
    std::vector<glm::dmat4> nodes; ///< world matrices of its file's nodes, joints among them
    glm::dmat4 placement{1};   ///< its file's world to positions of the scene that is open (Scene::origin)
    Palettes palettes;         ///< of its vertex arrays, `placement` in them
    prt::Bounds box{};         ///< around it, in the scene
    std::uint64_t version = 0; ///< another one where it has moved; 0: there is none

    /// The matrix of a node, placed in the scene.
    glm::dmat4 node(std::size_t index) const { return placement * nodes[index]; }
};

} // namespace viewer

#pragma once

// What of a scene moves as one: objects, or the bones of a skinned figure with what is nearest to them.
// Experimental.

#include "prt/gltf.h"

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace prt {

struct RigidPart {
    int node = 0;     ///< of the file, which carries it
    std::string name; ///< of the node; "node N" where it has none
    glm::dmat4 frame{
        1};      ///< of the node in the pose of the file: to where positions of the scene are seen from
    Scene scene; ///< its triangles alone, in the pose and with the origin of the whole; no lights
};

struct RigidPartsOptions {
    /// Parts whose box has a diagonal below this share of the whole scene's go with what carries them: a
    /// finger with its hand.
    double least_share = 0.12;
};

/// The parts of `scene`, which was extracted from `document`, in the order of their nodes. A node that an
/// animation moves or that is a joint carries what is below it, down to the next such node; a triangle of a
/// skin belongs to the joint that moves most of it. What nothing moves is one part for each root of the
/// hierarchy.
std::vector<RigidPart> rigid_parts(const GltfDocument& document, const Scene& scene,
                                   const RigidPartsOptions& options = {});

} // namespace prt

#pragma once

// Parts of a scene that move rigidly: objects, or the bones of a skinned figure with the triangles that they
// move. Experimental.

#include "prt/gltf.h"

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace prt {

/// A part of a scene that moves rigidly with one node.
struct RigidPart {
    int node = 0;        ///< the node that moves the part, as its index in the file
    std::string name;    ///< name of the node; "node N" if it has none
    glm::dmat4 frame{1}; ///< matrix from the frame of the node, in the pose of the file, to the frame of the
                         ///< scene's positions
    Scene scene; ///< the triangles of the part, in the pose and with the origin of the full scene; no lights
};

/// Settings of `rigid_parts`.
struct RigidPartsOptions {
    /// Minimum diagonal of a part's bounding box, as a fraction of the full scene's. Smaller parts are merged
    /// into their parent part, for example a finger into its hand.
    double min_share = 0.12;
};

/// Returns the parts of `scene`, which was extracted from `document`, in the order of their nodes. A node
/// that is animated or a joint owns its descendants, except those that belong to another such node below it.
/// A triangle of a skin belongs to the joint with the largest influence. Geometry that does not move forms
/// one part for each root of the hierarchy.
std::vector<RigidPart> rigid_parts(const GltfDocument& document, const Scene& scene,
                                   const RigidPartsOptions& options = {});

} // namespace prt

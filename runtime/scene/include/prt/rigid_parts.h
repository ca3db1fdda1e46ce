#pragma once

// Parts of a scene that move rigidly: objects, or the bones of a skinned figure with the triangles nearest to
// them. Experimental.

#include "prt/gltf.h"

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace prt {

struct RigidPart {
    int node = 0;        ///< index in the file of the node that moves the part
    std::string name;    ///< name of the node; "node N" if it has none
    glm::dmat4 frame{1}; ///< from the node, in the pose of the file, to the frame of the scene's positions
    Scene scene; ///< the triangles of the part, in the pose and with the origin of the full scene; no lights
};

struct RigidPartsOptions {
    /// Minimum box diagonal of a part as a fraction of the full scene's. Smaller parts are merged into their
    /// parent part: a finger into its hand.
    double min_share = 0.12;
};

/// Returns the parts of `scene`, which was extracted from `document`, in the order of their nodes. A node
/// that is animated or is a joint owns its descendants down to the next such node. A triangle of a skin
/// belongs to the joint with the largest influence. Geometry that does not move forms one part for each root
/// of the hierarchy.
std::vector<RigidPart> rigid_parts(const GltfDocument& document, const Scene& scene,
                                   const RigidPartsOptions& options = {});

} // namespace prt

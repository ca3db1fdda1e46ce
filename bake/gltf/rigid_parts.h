#pragma once

// Parts of a scene that move rigidly: objects, or the bones of a skinned figure with the triangles that they
// move. Experimental.

#include "prt/gltf/gltf.h"

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace prt {

/// A part of a scene that moves rigidly with one node.
struct RigidPart {
    int node = 0;        ///< the node that moves the part: index in the nodes of the GltfDocument
    std::string name;    ///< name of the node; "node N" if it has no name
    glm::dmat4 frame{1}; ///< matrix from the frame of the node, in the pose of the file, to positions in
                         ///< metres relative to Scene::origin
    /// The triangles of the part, in the pose of the file and with the origin of the full scene. Contains no
    /// lights and no notices. Materials do not emit light; opaque materials without transmission keep only
    /// `double_sided` and `casts_shadow`.
    Scene scene;
};

/// Rigid parts whose triangles are those of a high-poly model.
struct DetailedParts {
    /// Parts of the scene: nodes, names and frames are those of the scene. Triangles are those of the
    /// high-poly model, if it has any for the part.
    std::vector<RigidPart> parts = {};
    std::vector<std::string> own = {}; ///< names of the parts that keep their own triangles
    Scene scene = {};                  ///< triangles of all `parts`, with the origin of the original scene
    std::size_t unused = 0;            ///< number of triangles of the high-poly model that belong to no part
};

/// Settings of `rigid_parts`.
struct RigidPartsOptions {
    /// Minimum diagonal of the bounding box of a part, as a fraction of that of the full scene, 0..1. A
    /// smaller part is merged into the part of its nearest moving ancestor or root, for example a finger into
    /// its hand. A part that moves with a root node is never merged. 0: no part is merged.
    double min_share = 0.12;
};

/// Splits `scene`, which was extracted from `document`, into rigid parts, in ascending order of their nodes.
/// A node moves if the file animates its transform or it is a joint of a skin. A triangle belongs to the node
/// that draws it if this node moves, else to the nearest ancestor that moves, else to the root of the
/// hierarchy. A triangle of a skinned mesh belongs to the joint with the largest sum of weights. Throws
/// `Error` if this joint is not in the hierarchy of the scene.
std::vector<RigidPart> rigid_parts(const GltfDocument& document, const Scene& scene,
                                   const RigidPartsOptions& options = {});

/// Splits `scene` as `rigid_parts`, and replaces the triangles of parts by those of the high-poly model
/// `finer`, which was extracted from `high_poly`. The world of both files is the same. A node of the
/// high-poly model belongs to the part that contains the node of the scene with its name; without such a
/// name, to the part of its parent. A triangle of a skinned mesh belongs to the part of the joint with the
/// largest sum of weights. Throws the errors of `rigid_parts`, and `Error` if several nodes of the scene have
/// the name of a node of the high-poly model, or if no part has triangles of the high-poly model.
DetailedParts detailed_parts(const GltfDocument& document, const Scene& scene, const GltfDocument& high_poly,
                             const Scene& finer, const RigidPartsOptions& options = {});

} // namespace prt

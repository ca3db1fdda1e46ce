#pragma once

// Vertices for both sides of double-sided surfaces.

#include "cli/pipeline/model.h"
#include "prt/bake/pose_bake.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"

#include <span>
#include <string>
#include <vector>

namespace prt::pipeline {

enum class BackSides {
    automatic, ///< their own light, where light reaches both sides
    shared,    ///< the light of the front
};

/// Input of `separate_sides`.
struct SidesRequest {
    BackSides sides;
    const Path& path; ///< path of the scene, for messages
    const BakeOptions& options;
    const std::vector<std::string>& no_shadow;
    bool levels = false; ///< coarser levels of detail, too
    Notify notify = {};
};
/// Replaces document and scene by ones with separate vertices for both sides of double-sided surfaces, if the
/// light of the sides differs. Reports this as a notice, which is also added to the scene.
void separate_sides(const SidesRequest& request, GltfDocument& document, Scene& scene);
/// Like `separate_sides`, for a scene in which instances of `meshes` share transfer: a triangle of a mesh is
/// separated if light reaches its back in any instance. Replaces `meshes` by those of the new document.
void separate_sides_of_meshes(const SidesRequest& request, SharedMeshes& meshes, GltfDocument& document,
                              Scene& scene);

/// Like `separate_sides`, for the vertices with VertexArray::lobes of `scene`, which is that of `model` and
/// belongs to `document`: a triangle is separated if light reaches its back in any pose. Changes neither
/// other vertices nor their transfer. Returns whether `document` changed.
bool separate_sides_of_figure(const SidesRequest& request, const AnimatedScene& model, const Scene& scene,
                              std::span<const ModelPose> poses, GltfDocument& document);

} // namespace prt::pipeline

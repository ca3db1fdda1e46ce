#pragma once

// Bakes files whose instances share transfer: each instanced mesh is baked once, without surroundings. A few
// factors per instance describe the effect of its surroundings on the light (docs/math.md, section 22).
// Experimental.

#include "prt/bake/bake.h"
#include "prt/gltf/transfer_gltf.h"

#include <memory>
#include <vector>

namespace prt {

/// Settings for instances.
struct InstanceBakeOptions {
    /// Maximum number of samples of each instance, at least 8. Samples are receivers of the instance that are
    /// traced in its surroundings; the factors of the instance are fitted to their light.
    int samples = 256;
    /// Number of rays of a sample as a fraction of BakeOptions::rays, greater than 0 and at most 1. At least
    /// 16 rays are traced.
    double rays = 0.0625;
    /// Lightings under which errors are measured in addition to five built-in soft skies. They must not have
    /// lamps, and must have at least the order of the bake.
    std::vector<Lighting> lights = {};
};

/// The scene to bake, once with all instances and once as stored in the file. All members are references to
/// data of the caller.
struct InstanceScene {
    const Scene& scene;  ///< flat scene: every instance has its own vertices
    const Scene& stored; ///< contains each instanced mesh once, in its own frame, and everything that is
                         ///< drawn once
    const std::vector<SharedMesh>& meshes; ///< instanced meshes with their instances in `scene`
    const std::vector<int>& mesh_nodes;    ///< [meshes] node in `stored` that draws the mesh in its own frame
    const std::vector<int>& node_of; ///< [nodes of `scene`] the same node in `stored`; -1: the node is an
                                     ///< instance
    /// Result of an earlier call for the same `scene` and options (InstanceBake::flat_lamps), to bake its
    /// lamps once only; null: bake them.
    std::shared_ptr<const BakeResult> flat_lamps = {};
};

/// Measurements of a bake with instances.
struct InstanceStatistics {
    /// Number of receivers traced with BakeOptions::rays rays: the receivers of the instanced meshes, each
    /// mesh once, and of everything that is drawn once. Back sides that scatter light count, receivers
    /// without area do not.
    std::size_t receivers = 0;
    std::size_t samples = 0; ///< number of receivers traced in the surroundings of the instances, summed over
                             ///< all instances
    std::size_t rays = 0;    ///< number of all traced rays
    std::size_t lights = 0;  ///< number of InstanceBakeOptions::lights under which errors were measured
    std::size_t alone = 0;   ///< number of instances whose rays hit nothing except the instance itself
    int bounces = 0;         ///< number of bounces that were computed; at most 200 for kEndlessBounces
    double seconds = 0;      ///< total wall-clock time in seconds
    std::vector<std::string> notices; ///< parts of the scene that the bake left out or repaired, with
                                      ///< reasons, one line each
};

/// Result of a bake with instances. Instances are numbered mesh by mesh in the order of
/// InstanceScene::meshes, and within a mesh in the order of its placements.
struct InstanceBake {
    BakedTransfer baked;       ///< transfer of the receivers of InstanceScene::stored
    StoredInstances instances; ///< factors of the instances, and boxes of the meshes
    /// [instances] relative L2 error of exit radiance at the samples of the instance, without the noise of
    /// their rays. The value is the maximum of the error over the five soft skies together, and of the errors
    /// under each of InstanceBakeOptions::lights. 0 for an instance whose rays hit nothing except itself.
    std::vector<double> errors;
    /// [instances] relative L2 error of exit radiance at the vertices of the instance, of all lamps of the
    /// scene together; empty without lamps.
    std::vector<double> lamp_errors;
    std::shared_ptr<const BakeResult> flat_lamps; ///< bake of all lamps at all vertices; null without lamps
    InstanceStatistics statistics;
};

/// Largest ratio of the scales of instances that share the transfer of a mesh with a medium, because lengths
/// of the medium are metres. The mesh is baked at the mean of the scales.
inline constexpr double kMaxScaleRatio = 1.01;

/// Removes placements of meshes that contain a medium, unless their scales are those of the largest group
/// with ratios of at most kMaxScaleRatio; then meshes with less than two placements. `scene` is the flat
/// scene. Returns the number of removed placements. Throws `Error` for media that `bake` does not accept.
std::size_t keep_one_scale(SharedMeshes& meshes, const Scene& scene, const BakeOptions& options);

/// Bakes `scene` with shared transfer, without the noise filter. FitMode::automatic acts as FitMode::vertex.
/// With FitMode::surface, the written transfer is fitted to the surfaces; factors are fitted to light at
/// vertices. Lamps are baked at all vertices of `scene`, with the noise filter. Throws the errors of `bake`,
/// and `Error` for `samples` or `rays` of `instances` outside their range, and for an instance that does not
/// have the vertices of its mesh. BakeOptions::target_error is the error of each mesh alone and of all
/// surfaces that are drawn once; the share of samples is one of the mean number of rays. With
/// BakeMethod::raster, rays trace the samples. Instances of a mesh that contains a medium must
/// have the same scale (`keep_one_scale`).
InstanceBake bake_instances(const InstanceScene& scene, const BakeOptions& options,
                            const InstanceBakeOptions& instances = {}, const Progress& progress = {});

} // namespace prt

#pragma once

// Bakes each instanced mesh once, alone in the open, and for each instance a few factors that describe the
// influence of its surroundings on the light (docs/math.md, section 22). Experimental.

#include "prt/bake.h"
#include "prt/instances_gltf.h"

#include <vector>

namespace prt {

struct InstanceBakeOptions {
    int samples = 256;    ///< maximum number of receivers of each instance that are traced in its
                          ///< surroundings
    double rays = 0.0625; ///< rays of each sample, relative to those of a receiver; at least 16 rays
    /// Additional lights under which errors are measured, besides five soft skies; at least of the bake's
    /// order, without lamps.
    std::vector<Lighting> lights = {};
};

/// Scene that is baked: each instanced mesh once in its own frame, and everything that is drawn once.
struct InstanceScene {
    const Scene& scene;  ///< flat scene: every instance has its own vertices
    const Scene& stored; ///< scene as stored in the file, with separate meshes
    const std::vector<SharedMesh>& meshes;
    const std::vector<int>& stand_ins; ///< [meshes] their nodes in `stored`
    const std::vector<int>& node_of;   ///< [nodes of `scene`] nodes in `stored`; -1: an instance
};

struct InstanceStatistics {
    std::size_t receivers = 0; ///< receivers traced with all rays: those of the separate meshes and of
                               ///< everything that is drawn once
    std::size_t samples = 0;   ///< receivers traced in the surroundings of the instances
    std::size_t rays = 0;
    std::size_t lights = 0; ///< lights of the caller under which errors were measured
    std::size_t alone = 0;  ///< instances whose rays hit nothing except the instance itself
    int bounces = 0;        ///< bounces that were computed
    double seconds = 0;
    std::vector<std::string> notices;
};

struct InstanceBake {
    BakedTransfer baked; ///< transfer of the receivers of `stored`
    StoredInstances instances;
    /// [instances] relative L2 error of exit radiance at the samples, with the noise of their rays removed:
    /// the maximum of the error under the five soft skies together and the error under each of
    /// `InstanceBakeOptions::lights`.
    std::vector<double> errors;
    InstanceStatistics statistics;
};

/// Bakes `scene` with shared transfer. Throws `Error` for features that shared instances do not support:
/// lamps, media, depth maps, target errors and fits to the surface. Throws the same errors as `bake`.
InstanceBake bake_instances(const InstanceScene& scene, const BakeOptions& options,
                            const InstanceBakeOptions& instances = {}, const Progress& progress = {});

} // namespace prt

#pragma once

// Bakes files whose instances share transfer: each instanced mesh is baked once, without surroundings. A few
// factors per instance describe the effect of its surroundings on the light (docs/math.md, section 22).
// Experimental.

#include "prt/bake.h"
#include "prt/instances_gltf.h"

#include <vector>

namespace prt {

/// Settings for instances.
struct InstanceBakeOptions {
    int samples = 256; ///< maximum number of receivers of each instance that are traced in its surroundings;
                       ///< the factors are fitted to them
    double rays = 0.0625; ///< number of rays of such a receiver, relative to the bake's number of rays per
                          ///< receiver; at least 16 rays are traced
    /// Lightings under which errors are measured in addition to five soft skies; they have no lamps and at
    /// least the order of the bake.
    std::vector<Lighting> lights = {};
};

/// The scene to bake, flat and as stored in the file.
struct InstanceScene {
    const Scene& scene;  ///< every instance has its own vertices
    const Scene& stored; ///< each instanced mesh once in its own frame, and everything that is drawn once
    const std::vector<SharedMesh>& meshes;
    const std::vector<int>& mesh_nodes; ///< [meshes] node in `stored` that draws each mesh in its own frame
    const std::vector<int>& node_of;    ///< [nodes of `scene`] node in `stored`; -1: an instance
};

/// Measurements of a bake with instances.
struct InstanceStatistics {
    std::size_t receivers = 0; ///< receivers traced with all rays: those of the separate meshes and of
                               ///< everything that is drawn once
    std::size_t samples = 0;   ///< receivers traced in the surroundings of the instances
    std::size_t rays = 0;
    std::size_t lights = 0; ///< number of InstanceBakeOptions::lights under which errors were measured
    std::size_t alone = 0;  ///< instances whose rays hit nothing except the instance itself
    int bounces = 0;        ///< bounces that were computed
    double seconds = 0;
    std::vector<std::string> notices;
};

/// Result of a bake with instances.
struct InstanceBake {
    BakedTransfer baked; ///< transfer of the receivers of `stored`
    StoredInstances instances;
    /// [instances] relative L2 error of exit radiance at the traced receivers, without the noise of their
    /// rays. It is the maximum of the error over the five soft skies together and the errors under each of
    /// `InstanceBakeOptions::lights`.
    std::vector<double> errors;
    InstanceStatistics statistics;
};

/// Bakes `scene` with shared transfer. Throws `Error` for features that shared transfer does not support
/// (lamps, media, depth maps, target errors and fits to the surface), and the errors of `bake`.
InstanceBake bake_instances(const InstanceScene& scene, const BakeOptions& options,
                            const InstanceBakeOptions& instances = {}, const Progress& progress = {});

} // namespace prt

#pragma once

// Bakes meshes that are drawn often once, alone in the open, and for each instance a few factors that say
// what its place does to light (docs/math.md, section 22). Experimental.

#include "prt/bake.h"
#include "prt/instances_gltf.h"

#include <vector>

namespace prt {

struct InstanceBakeOptions {
    int samples = 256;    ///< receivers of each instance that are traced where it stands, at most
    double rays = 0.0625; ///< of those of a receiver, from each sample; 16 at least
    /// Under which errors are measured, beside five soft skies; of the bake's order at least, without lamps.
    std::vector<Lighting> lights = {};
};

/// What is baked once: meshes in their own frames, beside what is drawn once.
struct InstanceScene {
    const Scene& scene;  ///< flat: every instance has vertices of its own
    const Scene& stored; ///< as the file holds it: meshes apart
    const std::vector<SharedMesh>& meshes;
    const std::vector<int>& stand_ins; ///< [meshes] nodes of `stored`
    const std::vector<int>& node_of;   ///< [nodes of `scene`] in `stored`, -1: an instance
};

struct InstanceStatistics {
    std::size_t receivers = 0; ///< traced in full: of meshes alone, and of what is drawn once
    std::size_t samples = 0;   ///< traced where instances stand
    std::size_t rays = 0;
    std::size_t lights = 0; ///< given, under which errors were measured, too
    std::size_t alone = 0;  ///< instances none of whose rays met anything but themselves
    int bounces = 0;        ///< done
    double seconds = 0;
    std::vector<std::string> notices;
};

struct InstanceBake {
    BakedTransfer baked; ///< of the receivers of `stored`
    StoredInstances instances;
    /// [instances] relative L2 of exit radiance at the samples, without the noise of their rays: the
    /// largest under five soft skies together and under each of `InstanceBakeOptions::lights`.
    std::vector<double> errors;
    InstanceStatistics statistics;
};

/// Throws `Error` for what instances do not share: lamps, media, depth maps, errors to reach, fits to the
/// surface; and as `bake`.
InstanceBake bake_instances(const InstanceScene& scene, const BakeOptions& options,
                            const InstanceBakeOptions& instances = {}, const Progress& progress = {});

} // namespace prt

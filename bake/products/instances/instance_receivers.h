#pragma once

// Receivers of instances in a flat scene, their traced samples, and receivers that belong to no instance.

#include "bake/products/instances/instance_fit.h"
#include "bake/products/instances/shared_mesh_bake.h"
#include "prt/bake/instance_bake.h"

#include <cstdint>
#include <vector>

namespace prt {

struct InstanceReceivers {
    struct Instance {
        std::size_t mesh = 0;
        int node = 0;
        glm::dmat3 rotation{1};
        std::vector<std::uint32_t> receivers; ///< [receivers of the mesh, both sides] receivers of the flat
                                              ///< scene
        std::size_t first_sample = 0;
    };
    std::vector<Instance> instances;
    std::vector<InstanceSamples> samples; ///< [meshes]
    std::vector<std::uint32_t> sampled;   ///< [all samples] receivers of the flat scene
    std::vector<std::uint32_t> sample_of; ///< [receivers] index in `sampled`; kNoReceiver: no sample
    std::vector<std::uint32_t> own;       ///< receivers that belong to no instance, on surfaces
    std::vector<std::uint32_t> own_of;    ///< [receivers] index in `own`

    std::size_t samples_of(std::size_t instance) const {
        return samples[instances[instance].mesh].receivers.size();
    }
    std::size_t instance_of_sample(std::size_t sample) const;
};

/// Throws `Error` if the vertices of an instance differ from those of its mesh.
InstanceReceivers choose_receivers(const InstanceScene& scene, const BakePlan& plan,
                                   const std::vector<SharedMeshBake>& meshes, int samples);

} // namespace prt

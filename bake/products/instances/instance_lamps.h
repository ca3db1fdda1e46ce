#pragma once

// Light of the lamps of a scene at instances that share transfer.

#include "bake/products/instances/instance_receivers.h"
#include "bake/products/instances/shared_mesh_bake.h"
#include "prt/bake/bake.h"
#include "prt/core/instances.h"

#include <memory>
#include <span>
#include <vector>

namespace prt {

/// Bake of the lamps of a scene with instances.
struct InstanceLamps {
    /// Bake of the flat scene with one band; its lamp terms are the light of all receivers.
    std::shared_ptr<const BakeResult> flat;
    std::vector<std::vector<InstanceLampLight>> lights; ///< [instances][lamps]
    /// [instances] relative L2 error of the light of all lamps together at the vertices of the instance.
    std::vector<double> errors;

    std::span<const TransferTerm> terms() const { return flat->baked.transfer.layout.lamp_terms(); }
    /// Numbers of all lamp terms of a receiver of the flat scene.
    std::span<const float> numbers(std::size_t receiver) const {
        const Transfer& transfer = flat->baked.transfer;
        return transfer.vector(receiver).subspan(transfer.layout.distant_numbers());
    }
};

/// Bakes the lamps of `scene` at all vertices.
std::shared_ptr<const BakeResult> bake_lamps(const Scene& scene, BakeOptions options,
                                             const Progress& progress);

/// Fits the light of the lamps of `flat` at each instance to its vertices: least squares of exit radiance,
/// weighted by area (docs/math.md, section 22).
InstanceLamps fit_instance_lamps(std::shared_ptr<const BakeResult> flat,
                                 const std::vector<SharedMeshBake>& meshes,
                                 const InstanceReceivers& receivers, int threads);

} // namespace prt

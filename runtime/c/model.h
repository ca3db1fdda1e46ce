#pragma once

// The model handle of the C interface.

#include "prt/core/cluster_lighting.h"
#include "prt/core/instances.h"
#include "prt/load/model.h"
#include "runtime/c/boundary.h"

#include <mutex>
#include <optional>
#include <string>
#include <vector>

/// Instances that share transfer, sorted by mesh.
struct prt_shared_instances {
    prt::InstanceRelighter relighter;
    std::vector<glm::vec4> worlds, tables; ///< [instances][3], [instances][2]
    struct Range {
        std::size_t first = 0, count = 0;
    };
    std::vector<Range> of_meshes; ///< [primitives]
};

struct prt_model {
    prt::Scene scene;
    mutable prt::ClusteredTransfer transfer; ///< `transfer_for_cpu` adds coordinates
    prt::ClusterLighting relighter;
    std::vector<prt::ClusterLayout> layouts;
    std::optional<prt_shared_instances> instances = {};
    mutable std::once_flag has_coordinates = {};

    /// Returns `transfer` with the coordinates of predictors, which the first call computes.
    const prt::ClusteredTransfer& transfer_for_cpu() const;
};

namespace prt::c {

/// Converts a prt_constants, whose values equal those of ConstantSource. Throws `Error` for others.
ConstantSource source_of(int constants);

/// Returns the instances of `model`, which must have compressed transfer of vertices; empty if none share
/// transfer. Sorts the instances of `model` by mesh.
std::optional<prt_shared_instances> shared_instances(Model& model);

} // namespace prt::c

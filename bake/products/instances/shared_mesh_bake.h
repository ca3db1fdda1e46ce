#pragma once

// Bakes an instanced mesh without surroundings.

#include "bake/plan/plan.h"
#include "prt/core/instances.h"
#include "prt/core/progress.h"

#include <memory>
#include <vector>

namespace prt {

/// A baked mesh. Its receivers are its vertices, then back sides.
struct SharedMeshBake {
    std::unique_ptr<const Scene> scene; ///< scene in the mesh's frame, relative to its origin
    std::unique_ptr<const TraceScene> traced;
    std::unique_ptr<const BakePlan> plan;
    /// Exit transfer on both sides of surfaces after 0, 1, .. bounces; for endless bounces after none and
    /// after all. Its terms are `direct` with one channel and, if light bounces, `indirect`.
    std::vector<Transfer> after;
    InstanceBox box;
    std::size_t rays = 0;
    double sampling_error = 0;

    const Receivers& receivers() const { return plan->receivers(); }
    /// Position of a receiver in the mesh's box.
    glm::vec3 position_of(std::size_t receiver) const;
};

/// Bakes the primitives of `stored` that `node` draws. `channels`: channels of bounced light in the whole
/// scene.
SharedMeshBake bake_shared_mesh(const Scene& stored, int node, int channels, const BakeOptions& options,
                                const Progress& progress);

/// Returns exit transfer of the mesh's vertices as stored in files. The direct term has `direct_channels`;
/// the indirect term, if there is one, has the channels of `after`.
Transfer stored_transfer(const SharedMeshBake& mesh, int direct_channels);

/// Converts exit transfer [receivers of `plan`] on both sides to that of fronts, as stored in files.
Transfer of_fronts(const BakePlan& plan, const Transfer& both_sides, int direct_channels);

} // namespace prt

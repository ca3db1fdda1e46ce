#pragma once

// A mesh that is drawn often, baked alone in the open.

#include "plan.h"
#include "prt/instances.h"

#include <memory>
#include <vector>

namespace prt {

/// Receivers are those of the mesh's vertices, then back sides.
struct SharedMeshBake {
    std::unique_ptr<const Scene> scene; ///< in its own frame, from its origin on
    std::unique_ptr<const TraceScene> traced;
    std::unique_ptr<const BakePlan> plan;
    /// Exit transfer on both sides of surfaces after 0, 1, .. bounces; with endless ones after none and after
    /// all. Parts: `direct` of one channel and, where light bounces, `indirect`.
    std::vector<Transfer> after;
    InstanceBox box;
    std::size_t rays = 0;
    double sampling_error = 0;

    const Receivers& receivers() const { return plan->receivers(); }
    glm::vec3 place_of(std::size_t receiver) const;
};

/// Primitives of `stored` that `node` draws. `channels`: of light that bounced, in the whole scene.
SharedMeshBake bake_shared_mesh(const Scene& stored, int node, int channels, const BakeOptions& options,
                                const Progress& progress);

/// Exit transfer of the mesh's vertices, as files have it: of `direct_channels` and, where there are two
/// parts, of as many channels as `after` has.
Transfer stored_transfer(const SharedMeshBake& mesh, int direct_channels);

/// The same of exit transfer [receivers of `plan`] on both sides.
Transfer of_fronts(const BakePlan& plan, const Transfer& both_sides, int direct_channels);

} // namespace prt

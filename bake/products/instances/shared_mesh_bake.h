#pragma once

// Bakes an instanced mesh without surroundings.

#include "bake/plan/plan.h"
#include "prt/core/instances.h"
#include "prt/core/progress.h"

#include <memory>
#include <optional>
#include <vector>

namespace prt {

/// A baked mesh. Its receivers are its vertices, then back sides.
struct SharedMeshBake {
    std::unique_ptr<const Scene> scene; ///< scene in the mesh's frame, relative to its origin
    std::unique_ptr<const TraceScene> traced;
    std::unique_ptr<const BakeOptions> options; ///< of `plan`, with lengths in the mesh's frame
    std::unique_ptr<const BakePlan> plan;
    /// Exit transfer on both sides of surfaces after 0, 1, .. bounces; for endless bounces after none and
    /// after all. Its terms are `direct` with one channel and, if light bounces, `indirect`.
    std::vector<Transfer> after;
    /// As `after`, but with the light that arrives at media, before it is scattered: samples measure this
    /// light. Empty if the mesh contains no medium.
    std::vector<Transfer> arriving;
    /// Exit transfer to store in place of after.back(), fitted to samples between vertices; empty: no fit.
    std::optional<Transfer> fitted;
    InstanceBox box;
    std::size_t rays = 0;
    int mean_rays = 0; ///< mean number of rays of a receiver
    double sampling_error = 0;

    const Receivers& receivers() const { return plan->receivers(); }
    /// Transfer to which the light of samples is compared, after the same number of bounces as after[step].
    const Transfer& at_samples(std::size_t step) const {
        return arriving.empty() ? after[step] : arriving[step];
    }
    const Transfer& stored() const { return fitted ? *fitted : after.back(); }
    /// Position of a receiver in the mesh's box.
    glm::vec3 position_of(std::size_t receiver) const;
};

/// Whether a bake of `plan` has light other than direct light: bounces, or light through media.
bool has_rest(const BakePlan& plan);

/// A mesh to bake.
struct MeshToBake {
    int node = 0;     ///< node of the stored scene that draws the mesh in its own frame
    double scale = 1; ///< length in the world over length in the mesh's frame: media have a unit of length
};
/// Bakes the primitives of `stored` that the node draws, with the terms, channels, bounces and options of
/// `whole`, the plan of the flat scene.
SharedMeshBake bake_shared_mesh(const Scene& stored, const MeshToBake& to_bake, const BakePlan& whole,
                                const Progress& progress);

/// Returns exit transfer of the mesh's vertices as stored in files. The direct term has `direct_channels`;
/// the indirect term, if there is one, has the channels of `after`.
Transfer stored_transfer(const SharedMeshBake& mesh, int direct_channels);

/// Converts exit transfer [receivers of `plan`] on both sides to that of fronts, as stored in files.
Transfer of_fronts(const BakePlan& plan, const Transfer& both_sides, int direct_channels);

} // namespace prt

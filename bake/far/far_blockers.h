#pragma once

// What rays meet beyond a distance: voxels in the place of dense meshes, and the triangles of all others.

#include "far/blocker_volume.h"
#include "prt/far_blockers.h"
#include "prt/trace_scene.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace prt {

/// Immutable, thread-safe.
class FarBlockers {
public:
    /// From `distance` metres on. Keeps no reference to `scene`.
    FarBlockers(const TraceScene& scene, double distance);

    float distance() const { return distance_; }
    const BlockerVolume& volume() const { return *volume_; }
    /// Triangles that stay, and which of the scene's each is.
    const RayScene& others() const { return *others_; }
    std::uint32_t triangle_of(unsigned other) const { return triangles_[other]; }
    const FarBlockerFigures& figures() const { return figures_; }

private:
    float distance_;
    std::unique_ptr<const BlockerVolume> volume_;
    std::unique_ptr<const RayScene> others_;
    std::vector<std::uint32_t> triangles_; ///< [others]
    FarBlockerFigures figures_;
};

} // namespace prt

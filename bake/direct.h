#pragma once

// Direct light of a scene, and what its rays tell beside it.

#include "lamps/lamp_rows.h"
#include "plan.h"
#include "prt/tracer.h"
#include "transport/gather.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Light by half of the rays of each receiver.
struct HalfOfRays {
    Transfer direct;                      ///< of receivers and back sides, one channel
    std::optional<GatherOperator> gather; ///< where there are bounces
    std::vector<float> scale; ///< [receivers] factor on its difference from all rays that makes their noise

    /// Dark. `rays_of` [receivers].
    HalfOfRays(const BakePlan& plan, std::span<const std::uint32_t> rays_of);
};

struct DirectLight {
    Transfer transfer; ///< of receivers and back sides, one channel
    std::optional<GatherOperator>
        gather;                     ///< of the same rays, where there are bounces and they see something
    std::optional<LampRows> lamps;  ///< for the last bounce of lamps
    std::optional<HalfOfRays> half; ///< where noise is filtered
    std::size_t rays = 0;           ///< traced in all
    int mean_rays = 0;              ///< that a receiver has
    double mean_visibility = 0;     ///< area-weighted T_0 / Y_00
    double sampling_error = 0;      ///< estimated relative L2; 0: not estimated here
    std::vector<std::string> notices;
};

/// The gather operators keep references to `plan`. `lamps`: joins rows for lamps; may be null. `left`
/// [receivers]: factor that later means over receivers apply to the squared noise of each. The target and the
/// estimate of the sampling error include it.
DirectLight trace_direct(const BakePlan& plan, Tracer& tracer, const LampConnections* lamps,
                         std::span<const float> left, const Progress& progress);
/// Factor on the relative noise of a bake in which all receivers have the same noise.
double noise_left(const BakePlan& plan, std::span<const float> left);

} // namespace prt

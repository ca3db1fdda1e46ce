#pragma once

// Direct light of a scene, and the gather operator from the same rays.

#include "bake/pipeline/lamp_rows.h"
#include "bake/plan/plan.h"
#include "bake/trace/gather.h"
#include "bake/trace/tracer.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Light from half of the rays of each receiver.
struct HalfOfRays {
    Transfer direct;                      ///< transfer of receivers and back sides, one channel
    std::optional<GatherOperator> gather; ///< set if there are bounces
    std::vector<float> scale; ///< [receivers] factor on the difference from the transfer of all rays, which
                              ///< scales it to their noise

    /// Creates zero transfer. `rays_of` [receivers]: number of rays.
    HalfOfRays(const BakePlan& plan, std::span<const std::uint32_t> rays_of);
};

struct DirectLight {
    Transfer transfer;                    ///< transfer of receivers and back sides, one channel
    std::optional<GatherOperator> gather; ///< operator of the same rays; set if there are bounces and any ray
                                          ///< hits a scattering surface
    std::optional<LampRows> lamps;        ///< rows for the last bounce of lamps
    std::optional<HalfOfRays> half;       ///< set if noise is filtered
    std::size_t rays = 0;                 ///< all traced rays
    int mean_rays = 0;                    ///< mean number of rays per receiver
    double mean_visibility = 0;           ///< area-weighted mean of T_0 / Y_00
    double sampling_error = 0;            ///< estimated relative L2 error; 0: not estimated here
    std::vector<std::string> notices;
};

/// Traces direct light. The gather operators keep references to `plan`. `lamps`: creates rows for lamps; may
/// be null. `left` [receivers]: factor that later means over receivers apply to the squared noise of each.
/// The target and the estimate of the sampling error include it.
DirectLight trace_direct(const BakePlan& plan, Tracer& tracer, const LampConnections* lamps,
                         std::span<const float> left, const Progress& progress);
/// Factor that `left` applies to the relative noise of a bake in which all receivers have the same noise.
double noise_left(const BakePlan& plan, std::span<const float> left);

} // namespace prt

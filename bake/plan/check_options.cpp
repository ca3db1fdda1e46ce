// Validates BakeOptions.

#include "bake/plan/check_options.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"

#include <fmt/core.h>

#include <cmath>

namespace prt {
namespace {

void check_raster_options(const BakeOptions& options) {
    if (!options.tracer.falloff.blocks_everywhere())
        throw Error("--method raster does not support a distance fall-off; use --method trace");
    if (options.tracer.backend == Backend::cpu)
        throw Error("--method raster needs a GPU; do not use --device cpu");
    if (options.tracer.raster_resolution < 16 || options.tracer.raster_resolution > 16384)
        throw Error("the resolution of depth maps must be in 16..16384");
}

} // namespace

void check_finer(const FinerModel& finer) {
    if (finer.scene && !(finer.reach > 0 && finer.reach <= kFarthestVertex))
        throw Error(
            fmt::format("the distance of the high-poly model must be greater than 0 and at most {:g} m",
                        kFarthestVertex));
}

void check_options(const BakeOptions& options) {
    check_order(options.order);
    if (options.rays < 1 || options.rays > kMaxRays)
        throw Error(
            fmt::format("the number of rays per receiver must be in 1..{}, not {}", kMaxRays, options.rays));
    if (options.bounces != kEndlessBounces && (options.bounces < 0 || options.bounces > kMaxBounces))
        throw Error(fmt::format("the number of bounces must be in 0..{} or inf, not {}", kMaxBounces,
                                options.bounces));
    if (!(options.lamps.radius >= 0 && std::isfinite(options.lamps.radius)))
        throw Error("the radius of lamps must be finite and not negative");
    if (options.lamps.rays < 1 || options.lamps.rays > kMaxRays)
        throw Error(fmt::format("the number of rays per lamp must be in 1..{}, not {}", kMaxRays,
                                options.lamps.rays));
    if (options.target_error && !(*options.target_error > 0 && std::isfinite(*options.target_error)))
        throw Error("the target error must be finite and greater than 0");
    if (!(options.subsurface.metres_per_unit > 0 && std::isfinite(options.subsurface.metres_per_unit)))
        throw Error("the number of metres per unit must be finite and greater than 0");
    check_falloff(options.tracer.falloff);
    if (!options.tracer.falloff.blocks_everywhere() && options.bounces != 0)
        throw Error("a distance fall-off and bounces cannot be combined; use 0 bounces or no fall-off");
    if (options.tracer.method == BakeMethod::raster)
        check_raster_options(options);
}

} // namespace prt

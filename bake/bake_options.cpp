// Validates BakeOptions.

#include "bake_options.h"

#include "prt/sh.h"
#include "prt/support/error.h"

#include <fmt/core.h>

#include <cmath>

namespace prt {
namespace {

void check_raster_options(const BakeOptions& options) {
    if (!options.tracer.falloff.blocks_everywhere())
        throw Error("method raster does not tell how far away surfaces are: use method trace for a fall-off");
    if (options.tracer.backend == Backend::cpu)
        throw Error("method raster draws on the GPU: it has no CPU backend");
    if (options.bounces != 0)
        throw Error("method raster finds direct light only: use method trace for bounces");
    if (options.target_error)
        throw Error(
            "method raster takes the same directions everywhere: use method trace for an error to reach");
    if (options.fit == FitMode::surface)
        throw Error("method raster takes the same directions everywhere: use method trace for --fit surface");
    if (options.tracer.raster_resolution < 16 || options.tracer.raster_resolution > 16384)
        throw Error("the resolution of depth maps must lie in 16..16384");
}

} // namespace

void check_options(const BakeOptions& options) {
    check_order(options.order);
    if (options.rays < 1 || options.rays > kMaxRays)
        throw Error(fmt::format("rays per receiver must lie in 1..{}, not {}", kMaxRays, options.rays));
    if (options.bounces != kEndlessBounces && (options.bounces < 0 || options.bounces > kMaxBounces))
        throw Error(
            fmt::format("bounces must lie in 0..{} or be endless, not {}", kMaxBounces, options.bounces));
    if (!(options.lamps.radius >= 0 && std::isfinite(options.lamps.radius)))
        throw Error("the radius of lamps must be finite and not negative");
    if (options.lamps.rays < 1 || options.lamps.rays > kMaxRays)
        throw Error(fmt::format("rays to lamps must lie in 1..{}, not {}", kMaxRays, options.lamps.rays));
    if (options.target_error && !(*options.target_error > 0 && std::isfinite(*options.target_error)))
        throw Error("the error to reach must be finite and above 0");
    if (options.target_error && options.fit == FitMode::surface)
        throw Error("an error to reach is one of vertices: leave out the fit to the surface");
    if (!(options.subsurface.metres_per_unit > 0 && std::isfinite(options.subsurface.metres_per_unit)))
        throw Error("metres per unit must be finite and above 0");
    check_falloff(options.tracer.falloff);
    if (!options.tracer.falloff.blocks_everywhere() && options.bounces != 0)
        throw Error("light that bounces does not fall off: leave out bounces or the fall-off");
    if (options.tracer.method == BakeMethod::raster)
        check_raster_options(options);
}

} // namespace prt

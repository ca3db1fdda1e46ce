#pragma once

// Light that leaves the surfaces of a scene and has one bounce to go: what texels and probes gather.

#include "lamps/lamp_rows.h"
#include "plan.h"
#include "prt/tracer.h"

#include <optional>

namespace prt {

/// Exit transfer of all receivers of a plan, on both sides of surfaces, before the last bounce; of no
/// receivers where there is no such light.
struct BouncedSources {
    Transfer sky, lamps;
    std::optional<LampConnections> connections; ///< for the last bounce of lamps, where there is one
    int bounces = 0;                            ///< done, with the last
    std::size_t rays = 0;                       ///< traced
};

BouncedSources bounced_sources(const BakePlan& plan, Tracer& tracer, const Progress& progress);

} // namespace prt

#pragma once

// Light that leaves the surfaces of a scene before its last bounce. Texels and probes gather it.

#include "bake/pipeline/lamp_rows.h"
#include "bake/plan/plan.h"
#include "bake/trace/tracer.h"

#include <optional>

namespace prt {

/// Exit transfer of all receivers of a plan, on both sides of surfaces, before the last bounce. A transfer
/// without receivers means that there is no such light.
struct BounceSources {
    Transfer sky, lamps;
    std::optional<LampConnections> connections; ///< connections for the last bounce of lamps, if there is one
    int bounces = 0;                            ///< number of computed bounces, including the last one
    std::size_t rays = 0;                       ///< all traced rays

    const LampConnections* known_connections() const { return connections ? &*connections : nullptr; }
};

/// Measures light at the receivers of `plan` and propagates it up to the last bounce.
BounceSources bounce_sources(const BakePlan& plan, Tracer& tracer, const Progress& progress);

} // namespace prt

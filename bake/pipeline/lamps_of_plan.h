#pragma once

// Light of the lamps of a planned bake.

#include "bake/plan/plan.h"
#include "bake/scene/receivers.h"
#include "bake/trace/lamp_light.h"
#include "prt/core/progress.h"

#include <cstddef>
#include <cstdint>

namespace prt {

class Tracer;

/// Number and seed of the samples of lamps at receivers.
struct LampSamples {
    std::size_t divisor = 1; ///< each receiver uses LampOptions::rays divided by this number
    std::uint64_t seed = 0;
};

/// Computes the light of the lamps of `plan` at `receivers`.
LampLight light_of_lamps(const BakePlan& plan, Tracer& tracer, const Receivers& receivers,
                         const LampSamples& samples, const Progress& progress);

} // namespace prt

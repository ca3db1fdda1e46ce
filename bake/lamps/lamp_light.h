#pragma once

// Light of a scene's lamps at its receivers, by shadow rays (docs/math.md, section 13).

#include "lamps/choose_lamps.h"
#include "prt/receivers.h"
#include "prt/support/progress.h"
#include "prt/trace_scene.h"
#include "prt/transfer.h"

#include <atomic>
#include <cstdint>
#include <span>

namespace prt {

struct LampLightOptions {
    LampOptions lamps;
    int channels = 3; ///< 1 where all of them are white
    std::uint64_t seed = 0;
    int threads = 0;
};

/// What `lamps` give at strength 1, without a bounce, of receivers of albedo 1: transfer of one part whose
/// coefficient k is the light of lamp k; those past the last are zero. Adds the rays that it takes to
/// `rays`. Throws `Cancelled` when asked to stop.
Transfer lamp_light(const TraceScene& scene, const Receivers& receivers, std::span<const Lamp> lamps,
                    const LampLightOptions& options, std::size_t& rays, const Progress& progress);

} // namespace prt

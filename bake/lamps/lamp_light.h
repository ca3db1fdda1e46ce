#pragma once

// Light of a scene's lamps at its receivers, by shadow rays (docs/math.md, section 13).

#include "lamps/choose_lamps.h"
#include "plan.h"
#include "prt/receivers.h"
#include "prt/support/progress.h"
#include "prt/trace_scene.h"
#include "prt/transfer.h"

#include <cstdint>
#include <span>

namespace prt {

class Tracer;

/// Which light is asked for: what `lamps` give at strength 1, without a bounce, of receivers of albedo 1.
struct LampTask {
    const TraceScene& scene;
    const Receivers& receivers;
    std::span<const Lamp> lamps;
    LampOptions options;
    int channels = 3; ///< 1 where all of them are white
    std::uint64_t seed = 0;
    int threads = 0;
};

struct LampLight {
    Transfer transfer;    ///< of one part, whose coefficient k is the light of lamp k; past the last is zero
    std::size_t rays = 0; ///< that it took
};

/// Darkness for `task`.
LampLight no_lamp_light(const LampTask& task);
/// Writes the irradiance of receiver `p` by lamp `lamp`, as light of the task.
void put_irradiance(const LampTask& task, std::uint32_t p, std::size_t lamp, const glm::dvec3& irradiance,
                    LampLight& light);

/// Samples of lamps at receivers.
struct LampSamples {
    std::size_t divisor = 1; ///< each receiver takes LampOptions::rays over this
    std::uint64_t seed = 0;
};

/// Light of the lamps of `plan` at `receivers`.
LampLight light_of_lamps(const BakePlan& plan, Tracer& tracer, const Receivers& receivers,
                         const LampSamples& samples, const Progress& progress);

/// By rays through Embree's tree. Throws `Cancelled` when asked to stop.
LampLight lamp_light_on_cpu(const LampTask& task, const Progress& progress);

} // namespace prt

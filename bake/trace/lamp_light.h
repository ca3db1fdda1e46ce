#pragma once

// Light of a scene's lamps at its receivers, by shadow rays (docs/math.md, section 13).

#include "bake/scene/receivers.h"
#include "bake/scene/trace_scene.h"
#include "bake/trace/choose_lamps.h"
#include "prt/core/progress.h"
#include "prt/core/transfer.h"

#include <cstdint>
#include <span>

namespace prt {

class Tracer;

/// Requested light: light of `lamps` at strength 1, without a bounce, at receivers of albedo 1.
struct LampTask {
    const TraceScene& scene;
    const Receivers& receivers;
    std::span<const Lamp> lamps;
    LampOptions options;
    int channels = 3; ///< 1 if all lamps are white
    std::uint64_t seed = 0;
    int threads = 0;
};

struct LampLight {
    Transfer transfer; ///< one term, whose coefficient k is the light of lamp k; coefficients after the last
                       ///< lamp are zero
    std::size_t rays = 0; ///< traced rays
};

/// Returns zero light for `task`.
LampLight no_lamp_light(const LampTask& task);
/// Writes the irradiance of receiver `p` from lamp `lamp`, as light of the task.
void put_irradiance(const LampTask& task, std::uint32_t p, std::size_t lamp, const glm::dvec3& irradiance,
                    LampLight& light);

/// Computes the light by rays through Embree's hierarchy. Throws `Cancelled` when asked to stop.
LampLight lamp_light_on_cpu(const LampTask& task, const Progress& progress);

} // namespace prt

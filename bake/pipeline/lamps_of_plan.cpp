// Requests the light of a plan's lamps from the tracer.

#include "bake/pipeline/lamps_of_plan.h"

#include "bake/trace/tracer.h"

#include <algorithm>

namespace prt {

LampLight light_of_lamps(const BakePlan& plan, Tracer& tracer, const Receivers& receivers,
                         const LampSamples& samples, const Progress& progress) {
    LampTask task{.scene = plan.traced().scene,
                  .receivers = receivers,
                  .lamps = plan.lamps,
                  .options = plan.options.lamps,
                  .channels = plan.lamp_channels(),
                  .seed = samples.seed,
                  .threads = plan.options.threads};
    task.options.rays = std::max(1, task.options.rays / static_cast<int>(samples.divisor));
    return tracer.lamp_light(task, progress);
}

} // namespace prt

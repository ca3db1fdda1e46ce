#pragma once

// Direct transfer by one tracer, as the baker would find it.

#include "bake/scene/trace_scene.h"
#include "bake/trace/trace_receivers.h"

namespace prt::test {

/// Returns the transfer of the `receivers` that have an area and a normal; all others get zeros.
Transfer traced(Tracer& tracer, const Receivers& receivers, const TraceOptions& options,
                const ReceiverSink& sink = {});

/// Returns the transfer of one receiver under `scene`, on the CPU.
Transfer traced_at(const TraceScene& scene, const glm::vec3& position, const glm::vec3& normal,
                   const TraceOptions& options);

} // namespace prt::test

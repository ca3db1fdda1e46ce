#pragma once

// Direct transfer by one tracer, as the baker would find it.

#include "prt/trace_receivers.h"
#include "prt/trace_scene.h"

namespace prt::test {

/// Returns the transfer of the `receivers` that have an area and a normal; all others get zeros.
Transfer traced(Tracer& tracer, const Receivers& receivers, const TraceOptions& options,
                const ReceiverSink& sink = {});

/// Returns the transfer of one receiver under `scene`, on the CPU.
Transfer traced_at(const TraceScene& scene, const glm::vec3& position, const glm::vec3& normal,
                   const TraceOptions& options);

} // namespace prt::test

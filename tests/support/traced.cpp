// Traces transfer of receivers.

#include "support/traced.h"

#include "bake/tracers/make_tracer.h"

namespace prt::test {

Transfer traced(Tracer& tracer, const Receivers& receivers, const TraceOptions& options,
                const ReceiverSink& sink) {
    Transfer transfer = zero_transfer(options.order, 1, receivers.size());
    trace_receivers(tracer, receivers, receivers_on_surfaces(receivers), options, transfer, {}, sink);
    return transfer;
}

Transfer traced_at(const TraceScene& scene, const glm::vec3& position, const glm::vec3& normal,
                   const TraceOptions& options) {
    return traced(*make_tracer(scene, {.backend = Backend::cpu}), {{position}, {normal}, {1.0f}}, options);
}

} // namespace prt::test

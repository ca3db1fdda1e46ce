#pragma once

// Tracer on the CPU, with Embree.

#include "bake/scene/trace_scene.h"
#include "bake/trace/tracer.h"

namespace prt {

/// Traces on the CPU. Results do not depend on the number of threads.
class EmbreeTracer final : public Tracer {
public:
    /// Keeps a reference to `scene`, and builds its hierarchy of triangles.
    explicit EmbreeTracer(const TraceScene& scene);
    Backend backend() const override { return Backend::cpu; }
    std::string device() const override;
    std::size_t batch_size(const TraceOptions& options) const override;
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
               const Progress& progress = {}) override;
    LampLight lamp_light(const LampTask& task, const Progress& progress) override;

private:
    const TraceScene& scene_;
};

} // namespace prt

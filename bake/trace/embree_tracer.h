#pragma once

#include "far/far_blockers.h"
#include "prt/trace_scene.h"
#include "prt/tracer.h"

#include <optional>

namespace prt {

/// Traces on the CPU. Results do not depend on the number of threads.
class EmbreeTracer final : public Tracer {
public:
    /// Keeps a reference to `scene`, whose tree of triangles it builds. From `far_distance` on, metres,
    /// voxels stand in for dense meshes; 0: nowhere.
    explicit EmbreeTracer(const TraceScene& scene, double far_distance = 0);
    Backend backend() const override { return Backend::cpu; }
    std::string device() const override;
    std::size_t batch_size(const TraceOptions& options) const override;
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
               const Progress& progress = {}) override;
    LampLight lamp_light(const LampTask& task, const Progress& progress) override;
    const FarBlockers* far_blockers() const override { return far_ ? &*far_ : nullptr; }

private:
    const TraceScene& scene_;
    std::optional<FarBlockers> far_;
};

} // namespace prt

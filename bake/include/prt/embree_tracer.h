#pragma once

#include "prt/ray_scene.h"
#include "prt/surfaces.h"
#include "prt/tracer.h"

namespace prt {

/// Traces on the CPU. Results do not depend on the number of threads.
class EmbreeTracer final : public Tracer {
public:
    /// Keeps references to `scene` and `surfaces` (null: every surface is opaque). `threads` 0: all.
    explicit EmbreeTracer(const RayScene& scene, int threads = 0, const Surfaces* surfaces = nullptr)
        : scene_(scene), threads_(threads), surfaces_(surfaces) {}
    std::string backend() const override { return "cpu"; }
    std::string device() const override;
    std::size_t batch_size(const TraceOptions& options) const override;
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {}) override;

private:
    const RayScene& scene_;
    int threads_;
    const Surfaces* surfaces_;
};

} // namespace prt

#pragma once

// Tracer with a distance fall-off of occlusion.

#include "bake/scene/trace_scene.h"
#include "bake/trace/tracer.h"
#include "prt/bake/bake_options.h"

#include <memory>

namespace prt {

/// Traces with another tracer, and lets light pass the hit surfaces depending on their distance. A receiver
/// whose rays all hit surfaces, almost all of them backs of single-sided surfaces, keeps a zero vector: it is
/// inside geometry.
class FalloffTracer final : public Tracer {
public:
    /// `tracer` must report hits. Keeps a reference to `scene`.
    FalloffTracer(std::unique_ptr<Tracer> tracer, const TraceScene& scene, Falloff falloff);
    Backend backend() const override { return tracer_->backend(); }
    std::string device() const override { return tracer_->device(); }
    std::size_t batch_size(const TraceOptions& options) const override {
        return tracer_->batch_size(options);
    }
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
               const Progress& progress = {}) override;
    LampLight lamp_light(const LampTask& task, const Progress& progress) override;

private:
    /// Writes the light that passes the surfaces of `hits`, seen from `position`.
    void passing(const glm::vec3& position, std::span<const Hit> hits, const TraceOptions& options,
                 std::span<double> vector) const;

    std::unique_ptr<Tracer> tracer_;
    const TraceScene& scene_;
    Falloff falloff_;
    std::vector<glm::vec3> positions_; ///< positions of vertices
};

} // namespace prt

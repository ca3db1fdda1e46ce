#pragma once

#include "prt/falloff.h"
#include "prt/trace_scene.h"
#include "prt/tracer.h"

#include <memory>

namespace prt {

/// Traces by another tracer, and lets light pass what its rays meet by the distance. Of a receiver whose rays
/// all end, nearly all of them at backs of single-sided surfaces, the vector stays zero: it is inside
/// geometry.
class FalloffTracer final : public Tracer {
public:
    /// `tracer` notes hits. Keeps a reference to `scene`.
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
    /// Writes what passes the surfaces that `hits` are on, seen from `position`, of so many rays.
    void passing(const glm::vec3& position, std::span<const Hit> hits, const TraceOptions& options,
                 std::span<double> vector) const;

    std::unique_ptr<Tracer> tracer_;
    const TraceScene& scene_;
    Falloff falloff_;
    std::vector<glm::vec3> positions_; ///< of vertices
};

} // namespace prt

#pragma once

#include "prt/gl_context.h"
#include "prt/trace_scene.h"
#include "prt/tracer.h"
#include "trace/gpu/gpu_scene.h"

#include <map>
#include <memory>
#include <utility>

namespace prt {

/// Traces in a compute shader, through a wide quantised hierarchy. The same samples as EmbreeTracer. Work
/// goes to the device in pieces of about a tenth of a second, by the speed that was measured, and of so many
/// hits as `hit_bytes` hold.
class GlTracer final : public Tracer {
public:
    /// Keeps a reference to `scene` (for offsets off the surface); takes `context`, which stays current.
    /// Throws `Error` when the scene does not fit the device.
    GlTracer(std::unique_ptr<GlContext> context, const TraceScene& scene, std::size_t hit_bytes = 96 << 20);
    Backend backend() const override { return Backend::gpu; }
    std::string device() const override { return context_->renderer(); }
    std::size_t batch_size(const TraceOptions& options) const override;
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
               const Progress& progress = {}) override;
    LampLight lamp_light(const LampTask& task, const Progress& progress) override;
    /// Pieces that were traced again since their hits did not fit: only blended surfaces can make some, the
    /// first time that rays meet more of them than before.
    std::size_t traced_again() const { return traced_again_; }

private:
    struct Job;
    struct Chunks;
    class Batch;
    class HitBuffers;

    const GlObject& program(int order, bool hits);
    std::size_t hits_per_chunk(const TraceOptions& options) const;
    std::size_t chunks_at_once(const Job& job) const;
    void trace_piece(const Job& job);
    void trace_hits(const GlObject& shader, const Job& job, Chunks chunks,
                    std::vector<std::vector<Hit>>& hits);
    void dispatch(const GlObject& shader, std::size_t receivers, Chunks chunks);

    std::unique_ptr<GlContext> context_;
    const TraceScene& scene_;
    GpuScene gpu_scene_;
    std::size_t most_hits_; ///< of a dispatch
    std::size_t traced_again_ = 0;
    GlObject sh_factors_;
    std::map<std::pair<int, bool>, GlObject> programs_; ///< by order, and whether hits are noted
    double rays_per_second_ = 1e6;                      ///< until measured, that of a software rasteriser
    double hits_per_ray_ = 1; ///< through blended surfaces, a quarter more than measured
};

} // namespace prt

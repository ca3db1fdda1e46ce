#pragma once

#include "prt/trace_scene.h"
#include "prt/tracer.h"

#include <memory>

namespace prt {

struct GpuFailure;

/// Traces on a GPU while that lasts: where it is lost or runs out of memory on the way, the call that it
/// failed in and all that follow go to the CPU, and `device` says so.
class LastingTracer final : public Tracer {
public:
    /// Keeps a reference to `scene`. `lost`: what became of a GPU before.
    LastingTracer(std::unique_ptr<Tracer> tracer, const TraceScene& scene, std::string lost = {})
        : tracer_(std::move(tracer)), scene_(scene), lost_(std::move(lost)) {}
    Backend backend() const override { return tracer_->backend(); }
    std::string device() const override { return lost_ + tracer_->device(); }
    std::size_t batch_size(const TraceOptions& options) const override {
        return tracer_->batch_size(options);
    }
    /// A sink may be told again of a receiver.
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
               const Progress& progress = {}) override;
    LampLight lamp_light(const LampTask& task, const Progress& progress) override;
    /// Products go on with the processor, too.
    std::unique_ptr<GatherProduct> gather_product(const GatherOperator& gather) override;
    /// Sums that were there go with a GPU: they throw `GpuFailure`, and `backend` is the CPU from then on.
    std::unique_ptr<VectorSums> vector_sums(int order, std::span<const float> weights) override;

private:
    class Sums;
    void go_on_with_cpu(const GpuFailure& failure);
    /// Calls `work`, and adds up the time that the tracer took.
    template <class Work>
    auto counted(const Work& work);
    /// Calls `work`, and once more on the CPU where the GPU fails.
    template <class Work>
    auto lasting(const Work& work);

    std::unique_ptr<Tracer> tracer_;
    const TraceScene& scene_;
    std::string lost_; ///< what `device` says of a GPU that was
};

} // namespace prt

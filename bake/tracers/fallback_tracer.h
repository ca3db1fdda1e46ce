#pragma once

// Tracer with a fallback from the GPU to the CPU.

#include "bake/scene/trace_scene.h"
#include "bake/trace/tracer.h"

#include <memory>

namespace prt {

struct GpuFailure;

/// Traces on a GPU. If the GPU is lost or runs out of memory, the failed call and all following calls run on
/// the CPU, and `device` reports it.
class FallbackTracer final : public Tracer {
public:
    /// Keeps a reference to `scene`. `lost`: report about a GPU that failed earlier.
    FallbackTracer(std::unique_ptr<Tracer> tracer, const TraceScene& scene, std::string lost = {})
        : tracer_(std::move(tracer)), scene_(scene), lost_(std::move(lost)) {}
    Backend backend() const override { return tracer_->backend(); }
    std::string device() const override { return lost_ + tracer_->device(); }
    std::size_t batch_size(const TraceOptions& options) const override {
        return tracer_->batch_size(options);
    }
    /// After a fallback `sink` may get the hits of a receiver twice.
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
               const Progress& progress = {}) override;
    LampLight lamp_light(const LampTask& task, const Progress& progress) override;
    /// Creates products that also continue on the CPU.
    std::unique_ptr<GatherProduct> gather_product(const GatherOperator& gather) override;
    /// Creates sums on the GPU. Their contents are lost if the GPU fails: then they throw `GpuFailure`, and
    /// `backend` is the CPU from then on.
    std::unique_ptr<VectorSums> vector_sums(int order, std::span<const float> weights) override;

private:
    class Sums;
    void go_on_with_cpu(const GpuFailure& failure);
    /// Calls `work`, and adds the time of the tracer to `seconds_`.
    template <class Work>
    auto counted(const Work& work);
    /// Calls `work`, and repeats it on the CPU if the GPU fails.
    template <class Work>
    auto lasting(const Work& work);

    std::unique_ptr<Tracer> tracer_;
    const TraceScene& scene_;
    std::string lost_; ///< report about a failed GPU, for `device`
};

} // namespace prt

// Continues on the CPU if a GPU fails.

#include "bake/tracers/fallback_tracer.h"

#include "bake/device/gpu_failure.h"
#include "bake/trace/embree_tracer.h"
#include "bake/trace/gather.h"
#include "bake/trace/gather_product.h"
#include "bake/trace/lamp_light.h"
#include "bake/trace/vector_sums.h"

#include <fmt/core.h>

namespace prt {
namespace {

/// Computes products on a GPU; continues on the CPU if the GPU fails.
class LastingProduct final : public GatherProduct {
public:
    LastingProduct(std::unique_ptr<GatherProduct> gpu, const GatherOperator& gather, int threads)
        : gpu_(std::move(gpu)), gather_(gather), threads_(threads) {}

    void load(int order, std::span<const float> exit) override {
        order_ = order;
        exit_ = exit;
        reflected_.clear();
        while_it_lasts([&] { gpu_->load(order, exit); });
    }
    void apply(std::size_t first, std::span<float> to) override {
        if (while_it_lasts([&] { gpu_->apply(first, to); }))
            return;
        if (reflected_.empty()) {
            reflected_.assign(exit_.begin(), exit_.end());
            gather_.reflect(order_, reflected_, threads_);
        }
        gather_.apply(order_, reflected_, first, to, threads_);
    }
    bool apply_to_sums(const SumRows& to, std::span<float> sums) override {
        bool done = false;
        while_it_lasts([&] { done = gpu_->apply_to_sums(to, sums); });
        return done;
    }
    std::optional<BounceEnergy> bounce(Transfer& transfer, int bounces, const Progress& progress) override {
        std::optional<BounceEnergy> energy;
        while_it_lasts([&] { energy = gpu_->bounce(transfer, bounces, progress); });
        return energy;
    }
    std::size_t bytes_moved() const override { return gpu_ ? gpu_->bytes_moved() : 0; }

private:
    template <class Work>
    bool while_it_lasts(const Work& work) {
        try {
            if (gpu_)
                work();
        } catch (const GpuFailure&) {
            gpu_.reset();
        }
        return gpu_ != nullptr;
    }

    std::unique_ptr<GatherProduct> gpu_;
    const GatherOperator& gather_;
    int threads_, order_ = 0;
    std::span<const float> exit_;
    std::vector<float> reflected_; ///< `exit_` times reflectance, for the CPU; empty until it is needed
};

} // namespace

template <class Work>
auto FallbackTracer::counted(const Work& work) {
    const TraceSeconds before = tracer_->seconds();
    const auto count = [&] {
        const TraceSeconds after = tracer_->seconds();
        seconds_.trace += after.trace - before.trace;
        seconds_.accumulate += after.accumulate - before.accumulate;
        seconds_.transfer += after.transfer - before.transfer;
    };
    if constexpr (std::is_void_v<decltype(work())>) {
        work();
        count();
    } else {
        auto result = work();
        count();
        return result;
    }
}

template <class Work>
auto FallbackTracer::lasting(const Work& work) {
    try {
        return counted(work);
    } catch (const GpuFailure& failure) {
        go_on_with_cpu(failure);
        return counted(work);
    }
}

void FallbackTracer::go_on_with_cpu(const GpuFailure& failure) {
    lost_ = fmt::format("{}, then ({}) ", tracer_->device(), failure.what());
    tracer_ = std::make_unique<EmbreeTracer>(scene_);
}

class FallbackTracer::Sums final : public VectorSums {
public:
    Sums(FallbackTracer& tracer, std::unique_ptr<VectorSums> gpu) : tracer_(tracer), gpu_(std::move(gpu)) {}

    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<const SumRow> rows, std::span<float> first,
               const HitSink& sink, const Progress& progress) override {
        while_it_lasts([&] { gpu_->trace(receivers, indices, options, rows, first, sink, progress); });
    }
    void read(std::span<float> sums, std::span<float> signed_sums) override {
        while_it_lasts([&] { gpu_->read(sums, signed_sums); });
    }

private:
    template <class Work>
    void while_it_lasts(const Work& work) {
        try {
            tracer_.counted(work);
        } catch (const GpuFailure& failure) {
            gpu_.reset(); // before its device is destroyed
            tracer_.go_on_with_cpu(failure);
            throw;
        }
    }

    FallbackTracer& tracer_;
    std::unique_ptr<VectorSums> gpu_;
};

void FallbackTracer::trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                           const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                           const Progress& progress) {
    lasting([&] { tracer_->trace(receivers, indices, options, vectors, sink, progress); });
}

LampLight FallbackTracer::lamp_light(const LampTask& task, const Progress& progress) {
    return lasting([&] { return tracer_->lamp_light(task, progress); });
}

std::unique_ptr<GatherProduct> FallbackTracer::gather_product(const GatherOperator& gather) {
    std::unique_ptr<GatherProduct> product = lasting([&] { return tracer_->gather_product(gather); });
    return product ? std::make_unique<LastingProduct>(std::move(product), gather, scene_.threads()) : nullptr;
}

std::unique_ptr<VectorSums> FallbackTracer::vector_sums(int order, std::span<const float> weights) {
    std::unique_ptr<VectorSums> sums = lasting([&] { return tracer_->vector_sums(order, weights); });
    return sums ? std::make_unique<Sums>(*this, std::move(sums)) : nullptr;
}

} // namespace prt

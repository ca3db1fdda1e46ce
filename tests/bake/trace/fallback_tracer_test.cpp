// A GPU that fails on the way: the rest is traced on the CPU.

#include "bake/tracers/fallback_tracer.h"

#include "bake/device/gpu_failure.h"
#include "bake/pipeline/fitted_light.h"
#include "bake/plan/plan.h"
#include "bake/trace/embree_tracer.h"
#include "bake/trace/lamp_light.h"
#include "bake/trace/trace_receivers.h"
#include "bake/trace/vector_sums.h"
#include "prt/core/sh_basis.h"
#include "support/scene_builder.h"
#include "support/traced.h"

#include <gtest/gtest.h>

namespace prt {
namespace {

/// Traces a few batches, and then is gone.
class FailingTracer final : public Tracer {
public:
    FailingTracer(const TraceScene& scene, int batches) : tracer_(scene), batches_(batches) {}
    Backend backend() const override { return Backend::gpu; }
    std::string device() const override { return "a GPU"; }
    std::size_t batch_size(const TraceOptions&) const override { return 10; }
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
               const Progress& progress) override {
        tracer_.trace(receivers, indices, options, vectors, sink, progress);
        if (batches_-- == 0)
            throw GpuLost("it was taken away");
    }
    LampLight lamp_light(const LampTask&, const Progress&) override { throw GpuLost("it was taken away"); }

    std::unique_ptr<VectorSums> vector_sums(int, std::span<const float>) override {
        return std::make_unique<FailingSums>(*this);
    }

private:
    /// Sums whose results are lost.
    class FailingSums final : public VectorSums {
    public:
        explicit FailingSums(FailingTracer& tracer) : tracer_(tracer) {}
        void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                   const TraceOptions& options, std::span<const SumRow>, std::span<float> first,
                   const HitSink& sink, const Progress& progress) override {
            std::vector<float> vectors(indices.size() *
                                       static_cast<std::size_t>(coefficient_count(options.order)));
            tracer_.trace(receivers, indices, options, vectors, sink, progress);
            std::ranges::fill(first, 1.0f);
        }
        void read(std::span<float>, std::span<float>) override { throw GpuLost("it was taken away"); }

    private:
        FailingTracer& tracer_;
    };

    EmbreeTracer tracer_;
    int batches_;
};

/// Light fitted to a surface by a separate plan.
class Fitted {
public:
    const TraceScene& traced() const { return traced_; }
    FittedLight of(Tracer& tracer) const {
        return trace_fitted(plan_, tracer, LastOfLamps::as_others, 2, {});
    }

private:
    static BakeOptions some_options() {
        BakeOptions options;
        options.order = 3;
        options.rays = 64;
        options.bounces = 1;
        return options;
    }

    Scene scene_ = test::SceneBuilder().floor({0, 0, 0}, 2, 6).sphere({0, 1, 0}, 0.5f, 8).build();
    BakeOptions options_ = some_options();
    Media media_ = choose_media(scene_, options_);
    TraceScene traced_{scene_};
    BakePlan plan_ = plan_bake(traced_, media_, options_);
};

TEST(FallbackTracer, ContinuesOnTheCpu) {
    const Scene scene = test::SceneBuilder().floor({0, 0, 0}, 2, 6).sphere({0, 1, 0}, 0.5f, 8).build();
    const TraceScene traced(scene);
    const Receivers receivers = vertex_receivers(scene);
    const TraceOptions options{.order = 3, .rays = 64, .seed = 1};
    EmbreeTracer cpu(traced);
    const Transfer expected = test::traced(cpu, receivers, options);
    for (const int batches : {0, 2}) {
        FallbackTracer tracer(std::make_unique<FailingTracer>(traced, batches), traced);
        EXPECT_EQ(tracer.device(), "a GPU");
        EXPECT_EQ(test::traced(tracer, receivers, options).vectors, expected.vectors);
        EXPECT_EQ(tracer.backend(), Backend::cpu);
        EXPECT_EQ(tracer.device().find("a GPU, then (it was taken away) "), 0u) << tracer.device();
    }
    FallbackTracer lit(std::make_unique<FailingTracer>(traced, 0), traced);
    EXPECT_EQ(lit.lamp_light({.scene = traced, .receivers = receivers, .lamps = {}, .options = {}}, {}).rays,
              0u);
    EXPECT_EQ(lit.backend(), Backend::cpu);
}

TEST(FallbackTracer, RepeatsLostSums) {
    const Fitted fitted;
    EmbreeTracer cpu(fitted.traced());
    const FittedLight expected = fitted.of(cpu);
    for (const int batches : {0, 3, 1000}) { // in the middle of tracing, and when sums are read
        FallbackTracer tracer(std::make_unique<FailingTracer>(fitted.traced(), batches), fitted.traced());
        const FittedLight found = fitted.of(tracer);
        EXPECT_EQ(tracer.backend(), Backend::cpu);
        EXPECT_EQ(found.direct.transfer.vectors, expected.direct.transfer.vectors);
        EXPECT_EQ(found.direct.gather->entries(), expected.direct.gather->entries());
        EXPECT_EQ(found.direct.rays, expected.direct.rays);
        EXPECT_EQ(found.sealed.rays, expected.sealed.rays);
    }
    FailingTracer alone(fitted.traced(), 0); // there is no fallback
    EXPECT_THROW(fitted.of(alone), GpuLost);
}

} // namespace
} // namespace prt

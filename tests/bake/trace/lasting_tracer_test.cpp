// A GPU that fails on the way: the rest is traced on the CPU.

#include "trace/lasting_tracer.h"

#include "lamps/lamp_light.h"
#include "prt/gpu_failure.h"
#include "prt/trace_receivers.h"
#include "support/scene_builder.h"
#include "support/traced.h"
#include "trace/embree_tracer.h"

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

private:
    EmbreeTracer tracer_;
    int batches_;
};

TEST(LastingTracer, GoesOnWithTheCpu) {
    const Scene scene = test::SceneBuilder().floor({0, 0, 0}, 2, 6).sphere({0, 1, 0}, 0.5f, 8).build();
    const TraceScene traced(scene);
    const Receivers receivers = vertex_receivers(scene);
    const TraceOptions options{.order = 3, .rays = 64, .seed = 1};
    EmbreeTracer cpu(traced);
    const Transfer expected = test::traced(cpu, receivers, options);
    for (const int batches : {0, 2}) {
        LastingTracer tracer(std::make_unique<FailingTracer>(traced, batches), traced);
        EXPECT_EQ(tracer.device(), "a GPU");
        EXPECT_EQ(test::traced(tracer, receivers, options).vectors, expected.vectors);
        EXPECT_EQ(tracer.backend(), Backend::cpu);
        EXPECT_EQ(tracer.device().find("a GPU, then (it was taken away) "), 0u) << tracer.device();
    }
    LastingTracer lit(std::make_unique<FailingTracer>(traced, 0), traced);
    EXPECT_EQ(lit.lamp_light({.scene = traced, .receivers = receivers, .lamps = {}, .options = {}}, {}).rays,
              0u);
    EXPECT_EQ(lit.backend(), Backend::cpu);
}

} // namespace
} // namespace prt

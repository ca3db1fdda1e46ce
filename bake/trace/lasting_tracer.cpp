// Goes on with the CPU where a GPU fails.

#include "trace/lasting_tracer.h"

#include "lamps/lamp_light.h"
#include "prt/gpu_failure.h"
#include "trace/embree_tracer.h"

#include <fmt/core.h>

namespace prt {

template <class Work>
auto LastingTracer::lasting(const Work& work) {
    const auto counted = [&] {
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
    };
    try {
        return counted();
    } catch (const GpuFailure& failure) {
        lost_ = fmt::format("{}, then ({}) ", tracer_->device(), failure.what());
        tracer_ = std::make_unique<EmbreeTracer>(scene_);
        return counted();
    }
}

void LastingTracer::trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                          const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                          const Progress& progress) {
    lasting([&] { tracer_->trace(receivers, indices, options, vectors, sink, progress); });
}

LampLight LastingTracer::lamp_light(const LampTask& task, const Progress& progress) {
    return lasting([&] { return tracer_->lamp_light(task, progress); });
}

} // namespace prt

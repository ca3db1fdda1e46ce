// Sums vectors on the device: traced vectors are added there, and only the sums are read back.

#include "bake/trace_gpu/gpu_sum_row.h"
#include "bake/trace_gpu/vulkan_tracer.h"
#include "prt/core/sh_basis.h"

namespace prt {

class VulkanTracer::Sums final : public VectorSums {
public:
    Sums(VulkanTracer& tracer, int order, std::span<const float> weights)
        : tracer_(tracer), order_(order), weights_(weights.begin(), weights.end()) {
        const std::size_t bytes =
            weights.size() * static_cast<std::size_t>(coefficient_count(order)) * sizeof(std::int32_t);
        for (GpuBuffer* buffer : {&plain_, &with_signs_})
            *buffer = {tracer.device_, bytes, GpuMemory::device, "sums of vectors"};
        tracer.queue_.wait(tracer.queue_.submit([&](const vk::raii::CommandBuffer& commands) {
            for (const GpuBuffer* buffer : {&plain_, &with_signs_})
                commands.fillBuffer(buffer->handle(), 0, VK_WHOLE_SIZE, 0);
        }));
    }
    ~Sums() override { tracer_.queue_.wait_for_all(); }
    Sums(const Sums&) = delete;
    Sums& operator=(const Sums&) = delete;

    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<const SumRow> rows, std::span<float> first,
               const HitSink& sink, const Progress& progress) override {
        if (indices.empty())
            return;
        TraceJob job(receivers, indices, options, static_cast<bool>(sink), rows, weights_);
        const TracePiece::Sums sums{plain_, with_signs_};
        tracer_.trace(job, pieces_, &sums, TraceResults(job, tracer_.scene_, first, sink), progress);
    }

    void read(std::span<float> sums, std::span<float> signed_sums) override {
        with_vulkan_errors([&] {
            pieces_ = {}; // their memory is needed now
            const GpuBuffer host(tracer_.device_, plain_.bytes(), GpuMemory::download, "sums of vectors");
            const auto stride = static_cast<std::size_t>(coefficient_count(order_));
            const auto read_one = [&](const GpuBuffer& from, std::span<float> to) {
                tracer_.queue_.wait(tracer_.queue_.submit([&](const vk::raii::CommandBuffer& commands) {
                    copy(commands, from, host, host.bytes());
                    barrier_to_host(commands);
                }));
                const auto fixed = host.as<const std::int32_t>();
                for (std::size_t i = 0; i < to.size(); ++i)
                    to[i] = from_fixed_point(fixed[i], weights_[i / stride]);
            };
            read_one(plain_, sums);
            read_one(with_signs_, signed_sums);
        });
    }

private:
    VulkanTracer& tracer_;
    int order_;
    std::vector<float> weights_; ///< [sums]
    GpuBuffer plain_, with_signs_;
    Pieces pieces_;
};

std::unique_ptr<VectorSums> VulkanTracer::vector_sums(int order, std::span<const float> weights) {
    pieces_ = {}; // their memory is needed now
    try {
        return with_vulkan_errors([&] { return std::make_unique<Sums>(*this, order, weights); });
    } catch (const GpuMemoryError&) {
        return nullptr;
    }
}

} // namespace prt

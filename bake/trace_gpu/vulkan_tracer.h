#pragma once

// Tracer on a Vulkan device.

#include "bake/device/gpu_queue.h"
#include "bake/scene/trace_scene.h"
#include "bake/trace/tracer.h"
#include "bake/trace_gpu/gpu_scene.h"
#include "bake/trace_gpu/trace_job.h"
#include "bake/trace_gpu/trace_kernels.h"

#include <array>
#include <map>
#include <memory>

namespace prt {

/// Traces on a GPU: with ray queries of the device, or in a compute shader through a wide quantised
/// hierarchy. Uses the same samples as EmbreeTracer. Rays are submitted in pieces of about a twentieth of a
/// second, according to the measured speed; the CPU prepares one piece while another is traced. Throws
/// `GpuLost` if the device is lost.
class VulkanTracer final : public Tracer {
public:
    /// Keeps a reference to `scene`. `piece_bytes`: maximum size of a buffer of a piece. Throws `Error` if
    /// there is no such device, and if the scene does not fit into its memory.
    VulkanTracer(const TraceScene& scene, const VulkanChoice& choice, std::size_t piece_bytes = 64 << 20);
    Backend backend() const override { return Backend::gpu; }
    std::string device() const override;
    std::size_t batch_size(const TraceOptions& options) const override;
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
               const Progress& progress = {}) override;
    LampLight lamp_light(const LampTask& task, const Progress& progress) override;
    /// Returns null if the device has too little memory.
    std::unique_ptr<GatherProduct> gather_product(const GatherOperator& gather) override;
    /// Creates sums in fixed point, which do not depend on the order of the additions.
    std::unique_ptr<VectorSums> vector_sums(int order, std::span<const float> weights) override;
    const VulkanDevice& vulkan() const { return device_; }
    std::size_t scene_bytes() const { return scene_on_gpu_.bytes(); } ///< bytes in the device's memory
    /// Number of instances of meshes that are stored once.
    std::size_t copies() const { return scene_on_gpu_.copies(); }

private:
    class Sums;
    /// Two pieces that are used alternately, and the kernels that they were created for.
    struct Pieces {
        std::array<std::unique_ptr<TracePiece>, 2> two;
        const TraceKernels* kernels = nullptr;
    };

    TraceKernels& kernels(const TraceKernels::Kind& kind);
    TracePiece::Room room_for(const TraceJob& job) const;
    void trace(TraceJob& job, Pieces& pieces, const TracePiece::Sums* sums, TraceResults results,
               const Progress& progress);
    void prepare(const TraceJob& job, Pieces& pieces, const TracePiece::Sums* sums);
    gpu::TracePush next(const TraceJob& job, std::size_t receiver, std::size_t chunk) const;
    void run(const TraceJob& job, const Pieces& pieces, TraceResults& results, const Progress& progress);

    VulkanDevice device_;
    GpuQueue queue_;
    const TraceScene& scene_;
    GpuScene scene_on_gpu_;
    std::size_t piece_bytes_;
    std::map<TraceKernels::Kind, TraceKernels> kernels_;
    Pieces pieces_;
    double rays_per_second_ = 1e6; ///< until measured, the speed of a software device
    double hits_per_ray_ = 1;      ///< hits on blended surfaces, a quarter more than measured
};

} // namespace prt

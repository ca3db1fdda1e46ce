// Shadow rays to lamps in a compute shader (shaders/bake_lamps.comp): one lamp at a time, many receivers.

#include "bake/trace_gpu/vulkan_lamp_light.h"

#include "bake/scene/punctual.h"
#include "bake/trace/sample_sequence.h"
#include "bake/trace_gpu/lamp_tables.h"
#include "kernels/bake_lamps.h"
#include "kernels/bake_lamps_query.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/support/stopwatch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace prt {
namespace {

constexpr double kLampDispatchSeconds = 0.05;         ///< the driver of a desktop ends dispatches that take
                                                      ///< seconds
constexpr std::uint32_t kLampRaysAtOnce = 256;        ///< maximum rays per receiver in a dispatch, for the
                                                      ///< same reason
constexpr std::size_t kLampReceiversAtOnce = 1 << 18; ///< 16 MB in the device's memory

void write_receivers(const LampTask& task, std::span<const std::uint32_t> indices,
                     std::span<gpu::LampReceiver> receivers) {
    parallel_for(indices.size(), 256, task.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t p = indices[i];
            receivers[i] = {
                glm::vec4(task.scene.rays().ray_origin(task.receivers, p), std::bit_cast<float>(p)),
                glm::vec4(task.receivers.normals[p], 0), glm::vec4(task.receivers.positions[p], 0)};
        }
    });
}

/// The kernel with all its buffers, and its measured speed.
class LampKernel {
public:
    LampKernel(const VulkanDevice& device, GpuQueue& queue, const GpuScene& scene, const LampTask& task,
               std::size_t receivers)
        : task_(task), queue_(queue), tables_(make_lamp_tables(task.scene, task.lamps, scene.alpha())) {
        const auto upload = [&]<class T>(const std::vector<T>& values, const char* what) {
            return uploaded(device, queue, std::as_bytes(std::span(values)), what);
        };
        buffers_.lights = upload(tables_.lights, "the lights");
        buffers_.triangles = upload(tables_.triangles, "the emissive triangles");
        buffers_.images = upload(tables_.images, "the emissive textures");
        buffers_.texels = upload(tables_.texels, "the emissive texels");
        constexpr const char* kReceivers = "the receivers of lamps";
        const std::size_t bytes = receivers * sizeof(gpu::LampReceiver), sums = receivers * sizeof(glm::vec4);
        buffers_.staging = {device, bytes, GpuMemory::upload, kReceivers};
        buffers_.receivers = {device, bytes, GpuMemory::device, kReceivers};
        buffers_.sums = {device, sums, GpuMemory::device, "the light of lamps"};
        buffers_.read_back = {device, sums, GpuMemory::download, "the light of lamps"};
        GpuResources resources = scene.resources();
        resources.buffers.merge(
            std::map<std::uint32_t, const GpuBuffer*>{{PRT_BINDING_PUNCTUAL_LIGHTS, &buffers_.lights},
                                                      {PRT_BINDING_SHINING_TRIANGLES, &buffers_.triangles},
                                                      {PRT_BINDING_EMISSION_IMAGES, &buffers_.images},
                                                      {PRT_BINDING_EMISSION_TEXELS, &buffers_.texels},
                                                      {PRT_BINDING_RECEIVERS, &buffers_.receivers},
                                                      {PRT_BINDING_SUMS, &buffers_.sums}});
        GpuKernel::Source source{.spirv = device.traits().ray_queries
                                              ? std::span<const std::uint32_t>(bake_lamps_query)
                                              : bake_lamps,
                                 .push_bytes = sizeof(gpu::LampPush),
                                 .constants = scene.constants()};
        source.constants[PRT_CONSTANT_TEXTURED] = 0; // use the finest levels
        source.take_bindings(resources);
        kernel_ = GpuKernel(device, source);
        bindings_ = GpuBindings(device, kernel_, resources);
    }

    ~LampKernel() { queue_.wait_for_all(); }
    LampKernel(const LampKernel&) = delete;
    LampKernel& operator=(const LampKernel&) = delete;

    void set_receivers(std::span<const std::uint32_t> indices) {
        count_ = indices.size();
        write_receivers(task_, indices, buffers_.staging.as<gpu::LampReceiver>());
        queue_.wait(queue_.submit([&](const vk::raii::CommandBuffer& commands) {
            copy(commands, buffers_.staging, buffers_.receivers, count_ * sizeof(gpu::LampReceiver));
        }));
    }

    /// Traces irradiance of the receivers by one lamp, and the number of rays. The result is valid until the
    /// next call.
    std::span<const glm::vec4> trace(std::size_t lamp, const Progress& progress) {
        const LampTables::Ranges& ranges = tables_.ranges[lamp];
        gpu::LampPush push{.first_receiver = 0,
                           .receivers = static_cast<std::uint32_t>(count_),
                           .first_light = ranges.first_light,
                           .end_light = ranges.end_light,
                           .first_triangle = ranges.first_triangle,
                           .end_triangle = ranges.end_triangle,
                           .scramble = seed_scramble(task_.seed + lamp),
                           .max_rays = static_cast<std::uint32_t>(task_.options.rays),
                           .first_ray = 0,
                           .end_ray = 0,
                           .radius = static_cast<float>(task_.options.radius),
                           .nearest = static_cast<float>(kNearestToLight)};
        const std::uint32_t rays = max_rays(ranges);
        for (; push.first_ray < rays; push.first_ray += kLampRaysAtOnce) {
            const bool last = rays - push.first_ray <= kLampRaysAtOnce;
            push.end_ray =
                last ? std::numeric_limits<std::uint32_t>::max() : push.first_ray + kLampRaysAtOnce;
            trace_slice(std::min(rays, kLampRaysAtOnce) + (ranges.lights() + ranges.triangles()) / 8.0, push,
                        progress);
        }
        queue_.wait(queue_.submit([&](const vk::raii::CommandBuffer& commands) {
            copy(commands, buffers_.sums, buffers_.read_back, count_ * sizeof(glm::vec4));
            barrier_to_host(commands);
        }));
        return buffers_.read_back.as<const glm::vec4>().first(count_);
    }

private:
    struct Buffers {
        GpuBuffer lights, triangles, images, texels, staging, receivers, sums, read_back;
    };

    /// Maximum number of rays from a receiver to a lamp: the rays of each light are rounded up. At least one,
    /// so that dark receivers are also written.
    std::uint32_t max_rays(const LampTables::Ranges& ranges) const {
        const auto spread = static_cast<std::uint32_t>(task_.options.rays);
        return std::max(
            {1u, ranges.triangles() > 0 ? spread : 0, ranges.lights() > 0 ? spread + ranges.lights() : 0});
    }

    /// Traces a part of the rays of all receivers. `work` per receiver, in rays. Two dispatches are active at
    /// a time.
    void trace_slice(double work, gpu::LampPush push, const Progress& progress) {
        GpuQueue::Ticket before = 0;
        for (std::size_t begin = 0; begin < count_;) {
            progress.check();
            const auto in_time = static_cast<std::size_t>(work_per_second_ * kLampDispatchSeconds / work);
            const std::size_t size =
                std::min(count_ - begin, std::max<std::size_t>(in_time, PRT_LAMP_THREADS));
            push.first_receiver = static_cast<std::uint32_t>(begin);
            const Stopwatch watch;
            const std::size_t groups =
                std::min<std::size_t>((size + PRT_LAMP_THREADS - 1) / PRT_LAMP_THREADS, kMaxGroups);
            const std::size_t done = std::min(count_ - begin, groups * PRT_LAMP_THREADS);
            push.receivers = static_cast<std::uint32_t>(begin + done);
            const GpuQueue::Ticket ticket = queue_.submit([&](const vk::raii::CommandBuffer& commands) {
                kernel_.dispatch(commands, bindings_.handle(), push, groups);
            });
            queue_.wait(before);
            if (before == 0)
                queue_.wait(ticket); // the first dispatch measures the speed
            const double clock = queue_.seconds(before == 0 ? ticket : before),
                         took = clock > 0 ? clock : watch.seconds();
            work_per_second_ =
                0.5 * (work_per_second_ + work * static_cast<double>(done) / std::max(took, 1e-6));
            before = ticket;
            begin += done;
        }
        queue_.wait(before);
    }

    const LampTask& task_;
    GpuQueue& queue_;
    LampTables tables_;
    Buffers buffers_;
    GpuKernel kernel_;
    GpuBindings bindings_;
    std::size_t count_ = 0;
    double work_per_second_ = 1e6; ///< until measured, the speed of a software device
};

} // namespace

LampLight lamp_light_on_gpu(const VulkanDevice& device, GpuQueue& queue, const GpuScene& scene,
                            const LampTask& task, const Progress& progress) {
    LampLight light = no_lamp_light(task);
    const std::vector<std::uint32_t> indices = receivers_on_surfaces(task.receivers);
    if (task.lamps.empty() || indices.empty())
        return light;
    LampKernel kernel(device, queue, scene, task, std::min(kLampReceiversAtOnce, indices.size()));
    for (std::size_t first = 0; first < indices.size(); first += kLampReceiversAtOnce) {
        const auto batch =
            std::span(indices).subspan(first).first(std::min(kLampReceiversAtOnce, indices.size() - first));
        kernel.set_receivers(batch);
        for (std::size_t k = 0; k < task.lamps.size(); ++k) {
            const double done = static_cast<double>(k) / static_cast<double>(task.lamps.size());
            progress.update((static_cast<double>(first) + done * static_cast<double>(batch.size())) /
                            static_cast<double>(indices.size()));
            const std::span<const glm::vec4> sums = kernel.trace(k, progress);
            for (std::size_t i = 0; i < batch.size(); ++i) {
                if (!std::isfinite(sums[i].w))
                    throw GpuLoopsCutShort();
                put_irradiance(task, batch[i], k, glm::dvec3(sums[i]), light);
                light.rays += static_cast<std::size_t>(sums[i].w);
            }
        }
    }
    return light;
}

} // namespace prt

// Shadow rays to lamps in a compute shader (shaders/bake_lamps.comp): one lamp at a time, many receivers.

#include "trace/gpu/gl_lamp_light.h"

#include "lamps/punctual.h"
#include "prt/support/parallel.h"
#include "prt/support/stopwatch.h"
#include "trace/gpu/gpu_lamps.h"
#include "trace/gpu/gpu_structs.h"
#include "trace/sample_sequence.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace prt {
namespace {

constexpr double kLampDispatchSeconds = 0.1;          ///< a desktop's driver kills what takes seconds
constexpr std::uint32_t kLampRaysAtOnce = 256;        ///< of a receiver in a dispatch, for the same reason
constexpr std::size_t kLampReceiversAtOnce = 1 << 18; ///< in the device's memory: 16 MB

GlObject upload_lamp_receivers(const LampTask& task, std::span<const std::uint32_t> indices) {
    std::vector<gpu::LampReceiver> batch(indices.size());
    parallel_for(indices.size(), 256, task.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t p = indices[i];
            batch[i] = {glm::vec4(task.scene.rays().ray_origin(task.receivers, p), std::bit_cast<float>(p)),
                        glm::vec4(task.receivers.normals[p], 0), glm::vec4(task.receivers.positions[p], 0)};
        }
    });
    return make_buffer(std::span<const gpu::LampReceiver>(batch));
}

/// The shader, and how fast it was.
class LampShader {
public:
    LampShader(const GpuScene& scene, const LampTask& task)
        : task_(task), lamps_(scene, task.scene, task.lamps),
          program_(make_compute_program("bake_lamps.comp", scene.defines())) {
        glUseProgram(program_.name());
        scene.bind();
        lamps_.bind();
        set_uniform(program_, "radius", static_cast<float>(task.options.radius));
        set_uniform(program_, "nearest", static_cast<float>(kNearestToLight));
        set_uniform(program_, "most_rays", static_cast<std::uint32_t>(task.options.rays));
    }

    /// Light of one lamp at `count` receivers that are bound, in the sums that are bound.
    void trace(std::size_t lamp, std::size_t count, const Progress& progress) {
        const GpuLamps::Ranges& ranges = lamps_.ranges(lamp);
        set_uniform(program_, "first_light", ranges.first_light);
        set_uniform(program_, "end_light", ranges.end_light);
        set_uniform(program_, "first_triangle", ranges.first_triangle);
        set_uniform(program_, "end_triangle", ranges.end_triangle);
        set_uniform(program_, "scramble", seed_scramble(task_.seed + lamp));
        const std::uint32_t rays = most_rays(ranges);
        for (std::uint32_t ray = 0; ray < rays; ray += kLampRaysAtOnce) {
            const bool last = rays - ray <= kLampRaysAtOnce;
            set_uniform(program_, "first_ray", ray);
            set_uniform(program_, "end_ray",
                        last ? std::numeric_limits<std::uint32_t>::max() : ray + kLampRaysAtOnce);
            trace_slice(std::min(rays, kLampRaysAtOnce) + (ranges.lights() + ranges.triangles()) / 8.0, count,
                        progress);
        }
    }

private:
    /// That a receiver can have to a lamp: shares of them are rounded up for each light. One at least, so
    /// that what is dark is written, too.
    std::uint32_t most_rays(const GpuLamps::Ranges& ranges) const {
        const auto spread = static_cast<std::uint32_t>(task_.options.rays);
        return std::max(
            {1u, ranges.triangles() > 0 ? spread : 0, ranges.lights() > 0 ? spread + ranges.lights() : 0});
    }

    /// `work`: of a receiver, in rays.
    void trace_slice(double work, std::size_t count, const Progress& progress) {
        for (std::size_t begin = 0; begin < count;) {
            progress.check();
            const auto in_time = static_cast<std::size_t>(work_per_second_ * kLampDispatchSeconds / work);
            const std::size_t end = std::min(count, begin + std::max<std::size_t>(in_time, PRT_LAMP_THREADS));
            set_uniform(program_, "first_receiver", static_cast<std::uint32_t>(begin));
            set_uniform(program_, "end_receiver", static_cast<std::uint32_t>(end));
            const Stopwatch watch;
            glDispatchCompute(static_cast<GLuint>((end - begin + PRT_LAMP_THREADS - 1) / PRT_LAMP_THREADS), 1,
                              1);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
            glFinish();
            check_gl("light of lamps");
            work_per_second_ = 0.5 * (work_per_second_ + work * static_cast<double>(end - begin) /
                                                             std::max(watch.seconds(), 1e-6));
            begin = end;
        }
    }

    const LampTask& task_;
    GpuLamps lamps_;
    GlObject program_;
    double work_per_second_ = 1e6; ///< until measured, that of a software rasteriser
};

} // namespace

LampLight lamp_light_on_gpu(const GpuScene& scene, const LampTask& task, const Progress& progress) {
    LampLight light = no_lamp_light(task);
    const std::vector<std::uint32_t> indices = receivers_on_surfaces(task.receivers);
    if (task.lamps.empty() || indices.empty())
        return light;
    LampShader shader(scene, task);
    std::vector<glm::vec4> sums;
    for (std::size_t first = 0; first < indices.size(); first += kLampReceiversAtOnce) {
        const auto batch =
            std::span(indices).subspan(first).first(std::min(kLampReceiversAtOnce, indices.size() - first));
        const GlObject receivers = upload_lamp_receivers(task, batch),
                       gpu_sums = make_buffer_of(batch.size() * sizeof(glm::vec4));
        bind_storage(PRT_BINDING_RECEIVERS, receivers);
        bind_storage(PRT_BINDING_SUMS, gpu_sums);
        sums.resize(batch.size());
        for (std::size_t k = 0; k < task.lamps.size(); ++k) {
            const double done = static_cast<double>(k) / static_cast<double>(task.lamps.size());
            progress.update((static_cast<double>(first) + done * static_cast<double>(batch.size())) /
                            static_cast<double>(indices.size()));
            shader.trace(k, batch.size(), progress);
            read_buffer(gpu_sums, std::span(sums), "light of lamps");
            for (std::size_t i = 0; i < batch.size(); ++i) {
                put_irradiance(task, batch[i], k, glm::dvec3(sums[i]), light);
                light.rays += static_cast<std::size_t>(sums[i].w);
            }
        }
    }
    return light;
}

} // namespace prt

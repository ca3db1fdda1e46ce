// Creates the kernels from embedded SPIR-V (shaders/bake_*.comp).

#include "bake/trace_gpu/trace_kernels.h"

#include "bake/trace/vector_sums.h"
#include "kernels/bake_accumulate.h"
#include "kernels/bake_blocked.h"
#include "kernels/bake_blocked_query.h"
#include "kernels/bake_trace.h"
#include "kernels/bake_trace_query.h"
#include "prt/core/sh.h"
#include "prt/core/sh_basis.h"

namespace prt {
namespace {

static_assert(PRT_MAX_ORDER == kMaxOrder);

std::vector<glm::vec4> sh_factors() {
    std::vector<glm::vec4> factors(PRT_MAX_COEFFICIENTS, glm::vec4(0));
    const auto& k = detail::kLegendre;
    for (std::size_t m = 0; m < kMaxOrder; ++m) {
        factors[PRT_SH_FACTOR(m, m)].z = static_cast<float>(k.sectoral[m]);
        for (std::size_t l = m + 1; l < kMaxOrder; ++l) {
            factors[PRT_SH_FACTOR(l, m)].x = static_cast<float>(k.a[l][m]);
            factors[PRT_SH_FACTOR(l, m)].y = static_cast<float>(k.b[l][m]);
        }
        for (std::size_t l = m; l < kMaxOrder; ++l)
            factors[PRT_SH_FACTOR(l, m)].w = static_cast<float>(clamped_cosine_factor(static_cast<int>(l)));
    }
    return factors;
}

GpuKernel::Source kernel_source(std::span<const std::uint32_t> spirv, std::vector<std::uint32_t> own,
                                std::map<std::uint32_t, std::uint32_t> constants,
                                const GpuResources& scene = {{}}) {
    GpuKernel::Source source{.spirv = spirv,
                             .buffers = std::move(own),
                             .push_bytes = sizeof(gpu::TracePush),
                             .constants = std::move(constants)};
    source.take_bindings(scene);
    return source;
}

} // namespace

TraceKernels::TraceKernels(const VulkanDevice& device, GpuQueue& queue, const GpuScene& scene,
                           const Kind& kind)
    : kind_(kind), has_alpha_(scene.has_alpha()),
      samples_(device, 2 * PRT_CHUNK * sizeof(glm::uvec2), GpuMemory::device, "the samples") {
    const std::vector<glm::vec4> factors = sh_factors();
    sh_factors_ = uploaded(device, queue, std::as_bytes(std::span(factors)), "the factors of the basis");
    const GpuResources resources = scene.resources();
    const bool query = device.traits().ray_queries;
    std::map<std::uint32_t, std::uint32_t> constants = scene.constants();
    constants[PRT_CONSTANT_HITS] = kind.hits;
    trace_ =
        GpuKernel(device, kernel_source(query ? std::span<const std::uint32_t>(bake_trace_query) : bake_trace,
                                        {PRT_BINDING_SAMPLES, PRT_BINDING_RECEIVERS, PRT_BINDING_BLOCKED,
                                         PRT_BINDING_SHARES, PRT_BINDING_HITS, PRT_BINDING_HIT_COUNT,
                                         PRT_BINDING_PROGRESS},
                                        constants, resources));
    if (kind.hits && !has_alpha_)
        count_blocked_ = GpuKernel(
            device, kernel_source(query ? std::span<const std::uint32_t>(bake_blocked_query) : bake_blocked,
                                  {PRT_BINDING_SAMPLES, PRT_BINDING_RECEIVERS, PRT_BINDING_BLOCKED,
                                   PRT_BINDING_HITS, PRT_BINDING_BLOCKED_RAYS},
                                  constants, resources));
    const std::uint32_t subgroups =
        std::max(1u, PRT_BEAM / std::min<std::uint32_t>(PRT_BEAM, device.traits().min_subgroup));
    accumulate_ = GpuKernel(
        device, kernel_source(bake_accumulate,
                              {PRT_BINDING_SAMPLES, PRT_BINDING_RECEIVERS, PRT_BINDING_SUMS,
                               PRT_BINDING_BLOCKED, PRT_BINDING_SHARES, PRT_BINDING_SH_FACTORS,
                               PRT_BINDING_SUM_ROWS, PRT_BINDING_FIXED_SUMS, PRT_BINDING_SIGNED_SUMS},
                              {{PRT_CONSTANT_ALPHA, has_alpha_},
                               {PRT_CONSTANT_ORDER, static_cast<std::uint32_t>(kind.order)},
                               {PRT_CONSTANT_SUMMED, kind.summed},
                               {PRT_CONSTANT_SUBGROUPS, subgroups}}));
}

std::size_t TraceKernels::numbers() const {
    static_assert(first_coefficients(kMaxOrder) == PRT_FIRST_COEFFICIENTS);
    return kind_.summed ? first_coefficients(kind_.order)
                        : static_cast<std::size_t>(coefficient_count(kind_.order)) + 1;
}

GpuResources TraceKernels::tables() const {
    return {{{PRT_BINDING_SAMPLES, &samples_}, {PRT_BINDING_SH_FACTORS, &sh_factors_}}};
}

void TraceKernels::set_samples(const VulkanDevice& device, GpuQueue& queue,
                               std::span<const glm::uvec2> points) {
    const GpuBuffer staging(device, samples_.bytes(), GpuMemory::upload, "the samples");
    std::ranges::copy(points, staging.as<glm::uvec2>().begin());
    queue.wait(queue.submit([&](const vk::raii::CommandBuffer& commands) {
        copy(commands, staging, samples_, samples_.bytes());
    }));
}

} // namespace prt

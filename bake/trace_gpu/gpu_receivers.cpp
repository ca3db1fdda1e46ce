// Converts receivers to the layout of shaders.

#include "bake/trace_gpu/gpu_receivers.h"

#include "bake/trace/sample_sequence.h"
#include "runtime/core/support/parallel.h"

#include <bit>

namespace prt {

std::vector<gpu::Receiver> gpu_receivers(const TraceScene& scene, const Receivers& receivers,
                                         std::span<const std::uint32_t> indices, std::uint64_t seed) {
    std::vector<gpu::Receiver> batch(indices.size());
    parallel_for(indices.size(), 256, scene.threads(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t p = indices[i];
            batch[i] = {glm::vec4(scene.rays().ray_origin(receivers, p),
                                  std::bit_cast<float>(receiver_seed(p, seed))),
                        glm::vec4(receivers.normals[p], 0)};
        }
    });
    return batch;
}

} // namespace prt

// Direct transfer by rays with the open lobe as control variate (docs/math.md, eq. 7): of the blocked and the
// open rays of a chunk the fewer are summed. Open receivers get the lobe exactly, fully blocked ones exactly
// zero.

#include "prt/embree_tracer.h"

#include "chunk_kernels.h"
#include "prt/parallel.h"
#include "prt/sh.h"

#include <algorithm>
#include <bitset>
#include <limits>
#include <memory>

namespace prt {
namespace {

/// Traces the first `count` directions from `origin`. Bit i of `blocked` is set where ray i hits something.
int trace_chunk(RTCScene scene, const glm::vec3& origin, const ChunkDirections& directions, int count,
                std::bitset<kChunk>& blocked) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    // Packets are narrow beams (see SobolChunk), yet Embree's traversal for coherent rays is the slower one:
    // 25 against 28 million rays/s on the bunny. A beam of 1/64 of the hemisphere still fans out over many
    // small triangles.
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    RTCRay16 rays;
    for (int lane = 0; lane < kPacket; ++lane) {
        rays.org_x[lane] = origin.x;
        rays.org_y[lane] = origin.y;
        rays.org_z[lane] = origin.z;
        rays.tnear[lane] = 0;
        rays.time[lane] = 0;
        rays.mask[lane] = ~0u;
        rays.flags[lane] = 0;
    }
    alignas(64) int valid[kPacket];
    int hits = 0;
    for (int begin = 0; begin < count; begin += kPacket) {
        const auto b = static_cast<std::size_t>(begin);
        std::copy_n(&directions.x[b], kPacket, rays.dir_x);
        std::copy_n(&directions.y[b], kPacket, rays.dir_y);
        std::copy_n(&directions.z[b], kPacket, rays.dir_z);
        for (int lane = 0; lane < kPacket; ++lane) {
            rays.tfar[lane] = std::numeric_limits<float>::infinity();
            valid[lane] = begin + lane < count ? -1 : 0;
        }
        rtcOccluded16(valid, scene, &context, &rays);
        for (int lane = 0; lane < kPacket; ++lane) {
            const bool hit = valid[lane] != 0 && rays.tfar[lane] < 0; // Embree sets -infinity
            blocked[b + static_cast<std::size_t>(lane)] = hit;
            hits += hit;
        }
    }
    return hits;
}

/// Moves the directions whose bit in `blocked` equals `wanted` to the front.
void keep(ChunkDirections& directions, int count, const std::bitset<kChunk>& blocked, bool wanted) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        directions.x[kept] = directions.x[i];
        directions.y[kept] = directions.y[i];
        directions.z[kept] = directions.z[i];
        kept += blocked[i] == wanted;
    }
}

struct Plan {
    const RayScene& scene;
    const DirectOptions& options;
    SobolChunk whole, last; ///< all chunks but the last, and the last

    Plan(const RayScene& ray_scene, const DirectOptions& direct)
        : scene(ray_scene), options(direct), whole(kChunk), last((direct.rays - 1) % kChunk + 1) {}

    int chunks() const { return (options.rays + kChunk - 1) / kChunk; }
    const SobolChunk& chunk(int i) const { return i + 1 < chunks() ? whole : last; }
};

void trace_receiver(const Plan& plan, const glm::vec3& position, const glm::vec3& normal, std::uint32_t index,
                    ChunkDirections& directions, std::span<float> vector) {
    const auto coefficients = static_cast<std::size_t>(coefficient_count(plan.options.order));
    std::array<double, kMaxOrder * kMaxOrder> lobe{}, open{}, blocked{};
    clamped_cosine_lobe(plan.options.order, glm::dvec3(normal), lobe);
    const TangentFrame frame = tangent_frame(normal);
    const glm::vec3 origin = position + normal * plan.scene.surface_offset(position);
    const auto low = static_cast<std::uint32_t>(plan.options.seed);
    const auto high = static_cast<std::uint32_t>(plan.options.seed >> 32);
    const std::uint32_t seed = pcg_hash(index ^ pcg_hash(low ^ pcg_hash(high)));

    int control = 0; // rays of the chunks that use the control variate
    for (int c = 0; c < plan.chunks(); ++c) {
        const SobolChunk& chunk = plan.chunk(c);
        generate_directions(chunk, sobol_chunk_offset(static_cast<std::uint32_t>(c)), seed, frame,
                            directions);
        std::bitset<kChunk> hit;
        const int hits = trace_chunk(plan.scene.handle(), origin, directions, chunk.rays, hit);
        const bool mostly_open = 2 * hits <= chunk.rays;
        keep(directions, chunk.rays, hit, mostly_open);
        add_basis(plan.options.order, directions, mostly_open ? hits : chunk.rays - hits,
                  mostly_open ? blocked : open);
        control += mostly_open ? chunk.rays : 0;
    }
    for (std::size_t i = 0; i < coefficients; ++i)
        vector[i] = static_cast<float>((control * lobe[i] - blocked[i] + open[i]) / plan.options.rays);
}

} // namespace

std::size_t EmbreeTracer::batch_size(const DirectOptions& options) const {
    constexpr std::size_t kRaysPerThread = 1'000'000; // about a tenth of a second
    const auto rays = static_cast<std::size_t>(options.rays);
    return std::max<std::size_t>(1, kRaysPerThread / rays) * static_cast<std::size_t>(thread_count(threads_));
}

void EmbreeTracer::direct_transfer(const Receivers& receivers, std::span<const std::uint32_t> indices,
                                   const DirectOptions& options, std::span<float> vectors) {
    const Plan plan(scene_, options);
    const auto coefficients = static_cast<std::size_t>(coefficient_count(options.order));
    const auto grain = static_cast<std::size_t>(std::clamp(16384 / options.rays, 1, 16));
    parallel_for(indices.size(), grain, threads_, [&](std::size_t begin, std::size_t end) {
        const auto directions = std::make_unique<ChunkDirections>();
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t receiver = indices[i];
            trace_receiver(plan, receivers.positions[receiver], receivers.normals[receiver], receiver,
                           *directions, vectors.subspan(i * coefficients, coefficients));
        }
    });
}

} // namespace prt

// Direct transfer by ray tracing with the unshadowed lobe as control variate (docs/math.md, eq. 9): each
// chunk sums its blocked rays or its open rays, whichever are fewer. Open receivers get the exact lobe, fully
// blocked ones exactly zero.

#include "bake/trace/embree_tracer.h"

#include "bake/scene/opposite_triangles.h"
#include "bake/trace/chunk_kernels.h"
#include "bake/trace/lamp_light.h"
#include "prt/core/sh.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/support/stopwatch.h"
#include "shared_bake.h"

#include <embree3/rtcore.h>
#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace prt {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Plan {
    const RayScene& rays;
    const Surfaces& surfaces;
    const TraceOptions& options;
    SobolChunk whole, last; ///< all chunks except the last one, and the last chunk

    Plan(const TraceScene& scene, const TraceOptions& trace)
        : rays(scene.rays()), surfaces(scene.surfaces()), options(trace), whole(kChunk, trace.hit_stride),
          last((trace.rays - 1) % kChunk + 1, trace.hit_stride) {}

    int chunks() const { return (options.rays + kChunk - 1) / kChunk; }
    const SobolChunk& chunk(int i) const { return i + 1 < chunks() ? whole : last; }
};

/// Data that all rays of a receiver share, and the buffers of one thread.
struct Work {
    glm::vec3 origin, normal;
    ChunkDirections directions;
    alignas(64) float blocked[kChunk]; ///< blocked share of each ray, 0..1
    std::vector<Hit> hits;
    double seconds_trace = 0, seconds_accumulate = 0;
};

/// Creates a context. Packets are narrow beams (see SobolChunk). For closest hits Embree's traversal for
/// coherent rays is then faster (16 against 8 million rays/s and thread on the bunny); for occlusion it is
/// slower (25 against 28), because a beam of 1/64 of the hemisphere still spreads over many small triangles.
RTCIntersectContext make_context(RTCIntersectContextFlags flags) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = flags;
    return context;
}

void set_origin(RTCRay16& rays, const glm::vec3& origin) {
    for (int lane = 0; lane < kPacket; ++lane) {
        rays.org_x[lane] = origin.x;
        rays.org_y[lane] = origin.y;
        rays.org_z[lane] = origin.z;
        rays.time[lane] = 0;
        rays.mask[lane] = ~0u;
        rays.flags[lane] = 0;
    }
}

void set_directions(RTCRay16& rays, const ChunkDirections& directions, int begin, int lanes) {
    const auto b = static_cast<std::size_t>(begin);
    for (int lane = 0; lane < kPacket; ++lane) { // Embree also reads lanes that are not valid
        const std::size_t i = b + static_cast<std::size_t>(std::min(lane, lanes - 1));
        rays.dir_x[lane] = directions.x[i];
        rays.dir_y[lane] = directions.y[i];
        rays.dir_z[lane] = directions.z[i];
    }
    std::fill_n(rays.tnear, kPacket, 0.0f);
    std::fill_n(rays.tfar, kPacket, kInfinity);
}

/// Tests whether each of the rays [first, end) is blocked; all surfaces are opaque.
void trace_occlusion(const Plan& plan, int first, int end, Work& work) {
    RTCIntersectContext context = make_context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    RTCRay16 rays;
    set_origin(rays, work.origin);
    alignas(64) int valid[kPacket];
    for (int begin = first; begin < end; begin += kPacket) {
        const int lanes = std::min(kPacket, end - begin);
        set_directions(rays, work.directions, begin, lanes);
        for (int lane = 0; lane < kPacket; ++lane)
            valid[lane] = lane < lanes ? -1 : 0;
        rtcOccluded16(valid, plan.rays.handle(), &context, &rays);
        for (int lane = 0; lane < lanes; ++lane) // Embree sets -infinity
            work.blocked[begin + lane] = rays.tfar[lane] < 0 ? 1.0f : 0.0f;
    }
}

Hit hit_of(const Plan& plan, const glm::vec3& normal, const RTCRayHit16& packet, int lane, float weight) {
    const glm::vec3 direction(packet.ray.dir_x[lane], packet.ray.dir_y[lane], packet.ray.dir_z[lane]);
    const glm::vec3 face(packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane]);
    const float facing = glm::dot(face, direction), distance = packet.ray.tfar[lane];
    float footprint = 0;
    if (plan.surfaces.traits().textured)
        // Directions have density cos/pi: each of n rays represents a solid angle of pi/(n cos).
        footprint = std::numbers::pi_v<float> * distance * distance * glm::length(face) /
                    (static_cast<float>(plan.options.rays) * glm::dot(normal, direction) * std::abs(facing));
    if (!plan.surfaces.traits().alpha) // with alpha every ray is traced to its hit
        footprint *= static_cast<float>(plan.options.hit_stride);
    return plan.rays.opposites().shown(
        {packet.hit.primID[lane], packet.hit.u[lane], packet.hit.v[lane], weight, footprint, facing > 0});
}

constexpr float kMinTransmittance = PRT_MIN_TRANSMITTANCE;

/// A packet of rays that continue through surfaces that transmit a share of them.
struct alignas(64) Walk {
    int valid[kPacket];
    RTCRayHit16 packet;
    float left[kPacket]; ///< remaining share of each ray
};

/// Records the hits of the valid rays. Rays with a remaining share continue; returns their number.
int note_hits(const Plan& plan, bool alpha, Walk& walk, Work& work) {
    RTCRayHit16& packet = walk.packet;
    int active = 0;
    for (int lane = 0; lane < kPacket; ++lane) {
        if (walk.valid[lane] == 0)
            continue;
        walk.valid[lane] = 0;
        if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID)
            continue;
        float& left = walk.left[lane];
        Hit hit = hit_of(plan, work.normal, packet, lane, left);
        const float coverage =
            alpha ? plan.surfaces.coverage({hit.triangle, {hit.u, hit.v}, hit.footprint}) : 1.0f;
        const float passes = left * (1 - coverage);
        left = passes < kMinTransmittance ? 0.0f : passes;
        hit.weight -= left;
        if (hit.weight > 0)
            work.hits.push_back(hit);
        if (left > 0) {
            packet.ray.tnear[lane] = std::nextafter(packet.ray.tfar[lane], kInfinity);
            packet.ray.tfar[lane] = kInfinity;
            walk.valid[lane] = -1;
            ++active;
        }
    }
    return active;
}

/// Follows each of the rays [first, end) through cut-outs and blended surfaces until it ends, and records its
/// hits.
void trace_hits(const Plan& plan, int first, int end, Work& work) {
    RTCIntersectContext context = make_context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
    Walk walk;
    set_origin(walk.packet.ray, work.origin);
    const bool alpha = plan.surfaces.traits().alpha;
    for (int begin = first; begin < end; begin += kPacket) {
        const int lanes = std::min(kPacket, end - begin);
        set_directions(walk.packet.ray, work.directions, begin, lanes);
        for (int lane = 0; lane < kPacket; ++lane) {
            walk.left[lane] = 1;
            walk.valid[lane] = lane < lanes ? -1 : 0;
        }
        int active = lanes;
        while (active > 0) {
            std::fill_n(walk.packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
            std::fill_n(walk.packet.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
            rtcIntersect16(walk.valid, plan.rays.handle(), &context, &walk.packet);
            active = note_hits(plan, alpha, walk, work);
        }
        for (int lane = 0; lane < lanes; ++lane)
            work.blocked[begin + lane] = 1 - walk.left[lane];
    }
}

/// Follows some of the rays to their hits and tests the others only for occlusion; all surfaces are opaque.
/// The hits represent all blocked rays.
void trace_some_hits(const Plan& plan, const SobolChunk& chunk, Work& work) {
    const std::size_t before = work.hits.size();
    trace_hits(plan, 0, chunk.followed, work);
    trace_occlusion(plan, chunk.followed, chunk.rays, work);
    const auto blocked = std::count(work.blocked, work.blocked + chunk.rays, 1.0f);
    if (blocked > 0 && work.hits.size() == before) { // only rays that were not followed are blocked
        const auto first =
            static_cast<int>(std::find(work.blocked, work.blocked + chunk.rays, 1.0f) - work.blocked);
        trace_hits(plan, first, first + 1, work);
    }
    for (std::size_t h = before; h < work.hits.size(); ++h)
        work.hits[h].weight = static_cast<float>(blocked) / static_cast<float>(work.hits.size() - before);
}

/// Moves the directions of rays with a share to sum to the front; the shares go to `work.blocked`. Returns
/// the number of these rays; sets `whole` if all shares are 1.
int keep_shares(Work& work, int count, bool of_blocked, bool& whole) {
    std::size_t kept = 0;
    bool fractions = false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        const float share = of_blocked ? work.blocked[i] : 1 - work.blocked[i];
        work.directions.x[kept] = work.directions.x[i];
        work.directions.y[kept] = work.directions.y[i];
        work.directions.z[kept] = work.directions.z[i];
        work.blocked[kept] = share;
        kept += share > 0;
        fractions |= share > 0 && share < 1;
    }
    whole = !fractions;
    return static_cast<int>(kept);
}

/// Traces the rays of `chunk` in the directions of work.directions.
void trace_chunk(const Plan& plan, const SobolChunk& chunk, bool with_hits, Work& work) {
    if (plan.surfaces.traits().alpha)
        trace_hits(plan, 0, chunk.rays, work);
    else if (with_hits)
        trace_some_hits(plan, chunk, work);
    else
        trace_occlusion(plan, 0, chunk.rays, work);
}

/// Summed basis functions of a receiver's rays, [order²].
struct Sums {
    std::array<double, kMaxOrder * kMaxOrder> open{}, blocked{};
    int control = 0; ///< rays of the chunks that use the control variate
};

/// Adds the blocked or the open rays of a chunk, whichever are fewer.
void add_chunk(int order, int rays, Work& work, Sums& sums) {
    double hits = 0;
    for (int i = 0; i < rays; ++i)
        hits += static_cast<double>(work.blocked[i]);
    const bool mostly_open = 2 * hits <= rays;
    bool whole = true;
    const int kept = keep_shares(work, rays, mostly_open, whole);
    add_basis(order, work.directions, kept, whole ? nullptr : work.blocked,
              mostly_open ? sums.blocked : sums.open);
    sums.control += mostly_open ? rays : 0;
}

void trace_receiver(const Plan& plan, const Receivers& receivers, std::uint32_t index, bool with_hits,
                    Work& work, std::span<float> vector) {
    const TraceOptions& options = plan.options;
    work.normal = receivers.normals[index];
    work.origin = plan.rays.ray_origin(receivers, index);
    work.hits.clear();
    const TangentFrame frame = tangent_frame(work.normal);
    const std::uint32_t seed = receiver_seed(index, options.seed);
    Sums sums;
    for (int c = 0; c < plan.chunks(); ++c) {
        const SobolChunk& chunk = plan.chunk(c);
        const Stopwatch trace;
        generate_directions(chunk, sobol_offset(options.first_ray + static_cast<std::uint32_t>(c * kChunk)),
                            seed, frame, work.directions);
        trace_chunk(plan, chunk, with_hits, work);
        work.seconds_trace += trace.seconds();
        const Stopwatch accumulate;
        add_chunk(options.order, chunk.rays, work, sums);
        work.seconds_accumulate += accumulate.seconds();
    }
    std::array<double, kMaxOrder * kMaxOrder> lobe{};
    clamped_cosine_lobe(options.order, glm::dvec3(work.normal), lobe);
    for (std::size_t i = 0; i < vector.size(); ++i)
        vector[i] =
            static_cast<float>((sums.control * lobe[i] - sums.blocked[i] + sums.open[i]) / options.rays);
}

} // namespace

EmbreeTracer::EmbreeTracer(const TraceScene& scene) : scene_(scene) {
    scene.rays();
}

std::string EmbreeTracer::device() const {
    return fmt::format("Embree 3, {}", counted(thread_count(scene_.threads()), "thread"));
}

std::size_t EmbreeTracer::batch_size(const TraceOptions& options) const {
    constexpr std::size_t kRaysPerThread = 1'000'000; // about a tenth of a second
    const auto rays = static_cast<std::size_t>(options.rays);
    return std::max<std::size_t>(1, kRaysPerThread / rays) *
           static_cast<std::size_t>(thread_count(scene_.threads()));
}

void EmbreeTracer::trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                         const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                         const Progress&) {
    const Plan plan(scene_, options);
    const bool with_hits = static_cast<bool>(sink);
    const auto coefficients = static_cast<std::size_t>(coefficient_count(options.order));
    const auto grain = static_cast<std::size_t>(std::clamp(16384 / options.rays, 1, 16));
    const Stopwatch all;
    std::atomic<double> trace = 0, accumulate = 0;
    parallel_for(indices.size(), grain, scene_.threads(), [&](std::size_t begin, std::size_t end) {
        const auto work = std::make_unique<Work>();
        for (std::size_t i = begin; i < end; ++i) {
            trace_receiver(plan, receivers, indices[i], with_hits, *work,
                           vectors.subspan(i * coefficients, coefficients));
            if (sink) {
                const Stopwatch sinking;
                sink(i, work->hits);
                work->seconds_accumulate += sinking.seconds();
            }
        }
        trace += work->seconds_trace;
        accumulate += work->seconds_accumulate;
    });
    // Threads run in parallel: scale their times to the wall clock.
    const double busy = trace + accumulate, wall = all.seconds();
    seconds_.trace += busy > 0 ? wall * trace / busy : wall;
    seconds_.accumulate += busy > 0 ? wall * accumulate / busy : 0;
}

LampLight EmbreeTracer::lamp_light(const LampTask& task, const Progress& progress) {
    return lamp_light_on_cpu(task, progress);
}

} // namespace prt

// Direct transfer by rays with the open lobe as control variate (docs/math.md, eq. 9): of the blocked and the
// open rays of a chunk the fewer are summed. Open receivers get the lobe exactly, fully blocked ones exactly
// zero.

#include "trace/embree_tracer.h"

#include "lamps/lamp_light.h"
#include "prt/sh.h"
#include "prt/support/parallel.h"
#include "prt/support/stopwatch.h"
#include "shared_bake.h"
#include "trace/chunk_kernels.h"

#include <embree3/rtcore.h>
#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>

namespace prt {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A part of the way of rays, and what they meet there.
struct Stage {
    RTCSceneTy* triangles;
    float from, to;
    const FarBlockers* far; ///< null: triangles alone, numbered as the scene's

    std::uint32_t triangle(unsigned id) const { return far ? far->triangle_of(id) : id; }
};

struct Plan {
    const RayScene& rays;
    const Surfaces& surfaces;
    const TraceOptions& options;
    Stage near;
    std::optional<Stage> beyond;
    SobolChunk whole, last; ///< all chunks but the last, and the last

    Plan(const TraceScene& scene, const TraceOptions& trace, const FarBlockers* far)
        : rays(scene.rays()), surfaces(scene.surfaces()),
          options(trace), near{rays.handle(), 0, far ? far->distance() : kInfinity, nullptr},
          whole(kChunk, trace.hit_stride), last((trace.rays - 1) % kChunk + 1, trace.hit_stride) {
        if (far)
            beyond = {far->others().handle(), far->distance(), kInfinity, far};
    }

    int chunks() const { return (options.rays + kChunk - 1) / kChunk; }
    const SobolChunk& chunk(int i) const { return i + 1 < chunks() ? whole : last; }
};

/// Everything of a receiver that its rays share, and the space of one thread.
struct Work {
    glm::vec3 origin, normal;
    ChunkDirections directions;
    alignas(64) float blocked[kChunk]; ///< share of each ray that is blocked, 0..1
    std::vector<Hit> hits;
    double seconds_trace = 0, seconds_accumulate = 0;
};

/// Packets are narrow beams (see SobolChunk). For closest hits Embree's traversal for coherent rays is then
/// the faster one (16 against 8 million rays/s and thread on the bunny); for occlusion it is the slower one
/// (25 against 28), as a beam of 1/64 of the hemisphere still fans out over many small triangles.
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

void set_ways(RTCRay16& rays, const Stage& stage, const ChunkDirections& directions, int begin, int lanes) {
    const auto b = static_cast<std::size_t>(begin);
    for (int lane = 0; lane < kPacket; ++lane) { // Embree looks at lanes that are not valid, too
        const std::size_t i = b + static_cast<std::size_t>(std::min(lane, lanes - 1));
        rays.dir_x[lane] = directions.x[i];
        rays.dir_y[lane] = directions.y[i];
        rays.dir_z[lane] = directions.z[i];
    }
    std::fill_n(rays.tnear, kPacket, stage.from);
    std::fill_n(rays.tfar, kPacket, stage.to);
}

/// What voxels stop of those rays of a packet that are open.
void stop_in_voxels(const FarBlockers& far, int begin, int lanes, Work& work) {
    for (int lane = begin; lane < begin + lanes; ++lane)
        if (const auto i = static_cast<std::size_t>(lane); work.blocked[lane] <= 0)
            work.blocked[lane] =
                1 - far.volume().passes(work.origin,
                                        {work.directions.x[i], work.directions.y[i], work.directions.z[i]},
                                        far.distance(), kInfinity);
}

/// Finds what blocks each of the rays [first, end) that nothing blocked so far; every surface is opaque.
void trace_occlusion(const Stage& stage, int first, int end, Work& work) {
    RTCIntersectContext context = make_context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    RTCRay16 rays;
    set_origin(rays, work.origin);
    alignas(64) int valid[kPacket];
    for (int begin = first; begin < end; begin += kPacket) {
        const int lanes = std::min(kPacket, end - begin);
        set_ways(rays, stage, work.directions, begin, lanes);
        for (int lane = 0; lane < kPacket; ++lane)
            valid[lane] = lane < lanes && work.blocked[begin + lane] <= 0 ? -1 : 0;
        rtcOccluded16(valid, stage.triangles, &context, &rays);
        for (int lane = 0; lane < lanes; ++lane)
            if (rays.tfar[lane] < 0) // Embree sets -infinity
                work.blocked[begin + lane] = 1;
        if (stage.far)
            stop_in_voxels(*stage.far, begin, lanes, work);
    }
}

glm::vec3 direction_of(const RTCRay16& rays, int lane) {
    return {rays.dir_x[lane], rays.dir_y[lane], rays.dir_z[lane]};
}

/// Area of the surface that a ray stands for; 0 where no texture asks. `face`: normal of any length.
float footprint_of(const Plan& plan, const glm::vec3& normal, const glm::vec3& direction, float distance,
                   const glm::vec3& face) {
    if (!plan.surfaces.traits().textured)
        return 0;
    // Directions have density cos/pi: each of n rays stands for a solid angle of pi/(n cos).
    const float footprint = std::numbers::pi_v<float> * distance * distance * glm::length(face) /
                            (static_cast<float>(plan.options.rays) * glm::dot(normal, direction) *
                             std::abs(glm::dot(face, direction)));
    return footprint * static_cast<float>(plan.options.hit_stride);
}

Hit hit_of(const Plan& plan, const Stage& stage, const glm::vec3& normal, const RTCRayHit16& packet, int lane,
           float weight) {
    const glm::vec3 direction = direction_of(packet.ray, lane);
    const glm::vec3 face(packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane]);
    return {stage.triangle(packet.hit.primID[lane]),
            packet.hit.u[lane],
            packet.hit.v[lane],
            weight,
            footprint_of(plan, normal, direction, packet.ray.tfar[lane], face),
            glm::dot(face, direction) > 0};
}

constexpr float kLeastTransmittance = PRT_LEAST_TRANSMITTANCE;

/// A packet of rays on their way through what lets a share of them pass.
struct alignas(64) Walk {
    int valid[kPacket];
    RTCRayHit16 packet;
    float left[kPacket]; ///< share of each ray
};

/// What voxels leave of a ray on its way to what it met. A surface in one of them stands for all that they
/// stop.
void note_voxels(const Plan& plan, const BlockerVolume& volume, Walk& walk, int lane, Work& work) {
    const RTCRay16& rays = walk.packet.ray;
    const glm::vec3 direction = direction_of(rays, lane);
    const float stopped = 1 - volume.passes(work.origin, direction, rays.tnear[lane], rays.tfar[lane]);
    float& left = walk.left[lane];
    if (!(stopped * left > kLeastTransmittance))
        return;
    const std::uint32_t random = pcg_hash(std::bit_cast<std::uint32_t>(direction.x) ^
                                          pcg_hash(std::bit_cast<std::uint32_t>(direction.y)));
    const BlockerVolume::Met met = volume.end_of(work.origin, direction, rays.tnear[lane], stopped,
                                                 static_cast<float>(random >> 8) * 0x1p-24f);
    const float passes = left * (1 - stopped) < kLeastTransmittance ? 0.0f : left * (1 - stopped);
    work.hits.push_back({met.hit.triangle, met.hit.uv.x, met.hit.uv.y, left - passes,
                         footprint_of(plan, work.normal, direction, met.distance, direction), met.hit.back});
    left = passes;
}

/// Notes what the valid rays met. Those of which something is left go on; returns how many.
int note_hits(const Plan& plan, const Stage& stage, Walk& walk, Work& work) {
    RTCRayHit16& packet = walk.packet;
    const bool alpha = plan.surfaces.traits().alpha;
    int active = 0;
    for (int lane = 0; lane < kPacket; ++lane) {
        if (walk.valid[lane] == 0)
            continue;
        walk.valid[lane] = 0;
        if (stage.far)
            note_voxels(plan, stage.far->volume(), walk, lane, work);
        float& left = walk.left[lane];
        if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID || left <= 0)
            continue;
        Hit hit = hit_of(plan, stage, work.normal, packet, lane, left);
        const float coverage =
            alpha ? plan.surfaces.coverage({hit.triangle, {hit.u, hit.v}, hit.footprint}) : 1.0f;
        const float passes = left * (1 - coverage);
        left = passes < kLeastTransmittance ? 0.0f : passes;
        hit.weight -= left;
        if (hit.weight > 0)
            work.hits.push_back(hit);
        if (left > 0) {
            packet.ray.tnear[lane] = std::nextafter(packet.ray.tfar[lane], kInfinity);
            packet.ray.tfar[lane] = stage.to;
            walk.valid[lane] = -1;
            ++active;
        }
    }
    return active;
}

/// Follows what is left of each of the rays [first, end) through cut-outs and blended surfaces until it ends,
/// and notes what it met.
void trace_hits(const Plan& plan, const Stage& stage, int first, int end, Work& work) {
    RTCIntersectContext context = make_context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
    Walk walk;
    set_origin(walk.packet.ray, work.origin);
    for (int begin = first; begin < end; begin += kPacket) {
        const int lanes = std::min(kPacket, end - begin);
        set_ways(walk.packet.ray, stage, work.directions, begin, lanes);
        int active = 0;
        for (int lane = 0; lane < kPacket; ++lane) {
            walk.left[lane] = lane < lanes ? 1 - work.blocked[begin + lane] : 0.0f;
            walk.valid[lane] = walk.left[lane] > 0 ? -1 : 0;
            active -= walk.valid[lane];
        }
        while (active > 0) {
            std::fill_n(walk.packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
            std::fill_n(walk.packet.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
            rtcIntersect16(walk.valid, stage.triangles, &context, &walk.packet);
            active = note_hits(plan, stage, walk, work);
        }
        for (int lane = 0; lane < lanes; ++lane)
            work.blocked[begin + lane] = 1 - walk.left[lane];
    }
}

/// Follows the rays [first, end) all their way, and notes what they met.
void follow(const Plan& plan, int first, int end, Work& work) {
    std::fill(work.blocked + first, work.blocked + end, 0.0f);
    trace_hits(plan, plan.near, first, end, work);
    if (plan.beyond)
        trace_hits(plan, *plan.beyond, first, end, work);
}

/// Asks of the rays [first, end) whether they are blocked; every surface is opaque.
void ask(const Plan& plan, int first, int end, Work& work) {
    std::fill(work.blocked + first, work.blocked + end, 0.0f);
    trace_occlusion(plan.near, first, end, work);
    if (plan.beyond)
        trace_occlusion(*plan.beyond, first, end, work);
}

/// Follows some of the rays to what they meet and asks of the others only whether they are blocked; every
/// surface is opaque. The hits stand for all that is blocked.
void trace_some_hits(const Plan& plan, const SobolChunk& chunk, Work& work) {
    const std::size_t before = work.hits.size();
    follow(plan, 0, chunk.followed, work);
    ask(plan, chunk.followed, chunk.rays, work);
    const float blocked = std::accumulate(work.blocked, work.blocked + chunk.rays, 0.0f);
    if (blocked > 0 && work.hits.size() == before) { // only rays that were not followed are blocked
        const auto first =
            static_cast<int>(std::max_element(work.blocked, work.blocked + chunk.rays) - work.blocked);
        follow(plan, first, first + 1, work);
    }
    float noted = 0;
    for (std::size_t h = before; h < work.hits.size(); ++h)
        noted += work.hits[h].weight;
    for (std::size_t h = before; h < work.hits.size(); ++h)
        work.hits[h].weight *= blocked / noted;
}

/// Moves the directions of the rays with a share to sum to the front; that share goes to `work.blocked`.
/// Returns how many there are; `whole` is set where all shares are 1.
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

/// Finds what the rays of `chunk`, in work.directions, meet.
void trace_chunk(const Plan& plan, const SobolChunk& chunk, bool with_hits, Work& work) {
    if (plan.surfaces.traits().alpha)
        follow(plan, 0, chunk.rays, work);
    else if (with_hits)
        trace_some_hits(plan, chunk, work);
    else
        ask(plan, 0, chunk.rays, work);
}

/// Lobes of the rays of a receiver, [order²].
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

EmbreeTracer::EmbreeTracer(const TraceScene& scene, double far_distance) : scene_(scene) {
    scene.rays();
    if (far_distance > 0)
        far_.emplace(scene, far_distance);
}

std::string EmbreeTracer::device() const {
    return fmt::format("Embree 3, {} threads", thread_count(scene_.threads()));
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
    const Plan plan(scene_, options, far_ ? &*far_ : nullptr);
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
    // Threads work side by side: their times, scaled to the wall clock.
    const double busy = trace + accumulate, wall = all.seconds();
    seconds_.trace += busy > 0 ? wall * trace / busy : wall;
    seconds_.accumulate += busy > 0 ? wall * accumulate / busy : 0;
}

LampLight EmbreeTracer::lamp_light(const LampTask& task, const Progress& progress) {
    return lamp_light_on_cpu(task, progress);
}

} // namespace prt

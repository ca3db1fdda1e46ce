// Traces the rays of a probe as those of six receivers whose normals are the axes: together they are nearly
// uniform over the sphere, with density (|x| + |y| + |z|) / 6 pi, and every tracer can trace them. Light from
// unoccluded directions is the integral over the sphere minus the blocked part, as for receivers on surfaces.

#include "bake/products/volumes/probe_tracer.h"

#include "bake/products/volumes/outer_sums.h"
#include "bake/products/volumes/visibility.h"
#include "bake/trace/chunk_kernels.h"
#include "bake/trace/gather.h"
#include "bake/trace/lamp_light.h"
#include "bake/trace/trace_receivers.h"
#include "prt/core/sh.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/support/tangent_frame.h"
#include "runtime/core/support/vector_lanes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

/// Number of positions at once, so that the data of hit surfaces stay in a cache.
constexpr std::size_t kPositionsAtOnce = 128;
constexpr int kSides = 6;
/// Surfaces farther than this from the corner of a cell do not hide objects in the cell.
constexpr float kReachCells = 1.0f;

glm::vec3 side(int i) {
    glm::vec3 axis(0);
    axis[i / 2] = i % 2 == 0 ? -1.0f : 1.0f;
    return axis;
}

/// Computes to[i] += weight from[i].
PRT_TARGET_CLONES
void add_scaled(float weight, const float* from, std::size_t count, float* to) {
    for (std::size_t i = 0; i < count; ++i)
        to[i] += weight * from[i];
}

/// Computes the weighted sum of three rows.
PRT_TARGET_CLONES
void mix_rows(const glm::vec3& weights, const std::array<const float*, 3>& rows, std::size_t count,
              float* to) {
    for (std::size_t i = 0; i < count; ++i)
        to[i] = weights.x * rows[0][i] + weights.y * rows[1][i] + weights.z * rows[2][i];
}

} // namespace

/// Buffers of one thread.
struct ProbeTracer::Space {
    std::vector<float> vectors; ///< [coefficients][numbers]
    /// Sums by direction, [coefficients][order²], of blocked rays and of all rays; and light from surfaces.
    OuterSums blocked, all, reflected;
    ChunkDirections directions;
    VisibilityVotes visibility;
    double shut = 0, backs = 0; ///< number of rays
    std::array<float, kMaxOrder * kMaxOrder> basis{};
    ProbeView seen;
};

ProbeTracer::ProbeTracer(const BakePlan& plan, Tracer& tracer, BounceSources sources, int order)
    : plan_(plan), tracer_(tracer), whole_(kChunk), last_(1),
      reflectance_(shared_reflectance(plan.scene.surfaces(), *plan.transport)) {
    layout_.order = order;
    layout_.sky = layout_of_one(plan.options.order, 1, TermKind::direct);
    if (plan.bounces != 0)
        layout_.sky.terms.push_back({TermKind::indirect, plan.channels});
    if (!plan.lamps.empty())
        layout_.lamps = sources.lamps.layout;
    sky_ = std::move(sources.sky.vectors);
    if (plan.bounces != 0)
        lamps_ = std::move(sources.lamps.vectors);
    const auto reflect = [&](int bands, int channels, std::vector<float>& exit) {
        if (!exit.empty())
            GatherOperator(plan.scene.surfaces(), *plan.transport, 0, channels)
                .reflect(bands, exit, plan.options.threads);
    };
    reflect(layout_.sky.order, plan.channels, sky_);
    reflect(layout_.lamps.order, layout_.lamps.channels(), lamps_);
    for (const Lamp& lamp : plan.lamps)
        shining_.emplace_back(plan.scene, lamp);
}

void ProbeTracer::trace(const Task& task, const Progress& progress,
                        const std::function<void(std::size_t, const ProbeView&)>& take) {
    rays_along_ = std::max(1, (task.rays + kSides - 1) / kSides);
    last_ = SobolChunk((rays_along_ - 1) % kChunk + 1);
    for (std::size_t begin = 0; begin < task.positions.size(); begin += kPositionsAtOnce) {
        progress.check();
        trace_batch(task, begin, std::min(begin + kPositionsAtOnce, task.positions.size()), take);
        progress.update(static_cast<double>(std::min(begin + kPositionsAtOnce, task.positions.size())) /
                        static_cast<double>(task.positions.size()));
    }
}

void ProbeTracer::trace_batch(const Task& task, std::size_t begin, std::size_t end,
                              const std::function<void(std::size_t, const ProbeView&)>& take) {
    const std::size_t count = end - begin;
    Receivers receivers;
    std::vector<std::uint32_t> indices;
    for (std::size_t p = begin; p < end; ++p)
        for (int s = 0; s < kSides; ++s) {
            indices.push_back(static_cast<std::uint32_t>(receivers.size()));
            receivers.positions.push_back(task.positions[p]);
            receivers.normals.push_back(side(s));
            receivers.areas.push_back(1);
            receivers.starts.emplace_back(0);
        }
    const TraceOptions options{.order = 1, .rays = rays_along_, .seed = task.seed + begin};
    std::vector<std::vector<Hit>> hits(receivers.size());
    Transfer unused = zero_transfer(1, 1, receivers.size());
    trace_receivers(
        tracer_, receivers, indices, options, unused, {},
        [&](std::uint32_t r, std::span<const Hit> met) { hits[r].assign(met.begin(), met.end()); });
    std::atomic<std::size_t> of_lamps = 0;
    parallel_for(count, 16, plan_.options.threads, [&](std::size_t first, std::size_t last) {
        Space space;
        for (std::size_t i = first; i < last; ++i) {
            see({.positions = task.positions.subspan(begin, count),
                 .cells = task.cells.empty() ? task.cells : task.cells.subspan(begin, count),
                 .seed = options.seed},
                i, std::span(hits).subspan(i * kSides, kSides), space);
            if (!plan_.lamps.empty())
                of_lamps += add_lamps(task, begin + i, space);
            take(begin + i, space.seen);
        }
    });
    rays_ += count * kSides * static_cast<std::size_t>(rays_along_) + of_lamps;
}

void ProbeTracer::see(const Task& task, std::size_t position, std::span<const std::vector<Hit>> hits,
                      Space& space) const {
    const std::size_t coefficients = layout_.coefficients(), direct = layout_.direct(),
                      numbers = layout_.numbers();
    if (!task.cells.empty())
        space.visibility.begin(task.cells[position].corner - task.positions[position],
                               kReachCells * task.cells[position].width);
    space.shut = space.backs = 0;
    space.blocked.begin(coefficients, direct);
    space.all.begin(coefficients, direct);
    space.reflected.begin(coefficients, numbers - direct);
    for (const std::vector<Hit>& of_side : hits)
        for (const Hit& hit : of_side)
            add_hit(hit, task, position, space);
    // All directions: the unit matrix, or if most directions are blocked the sum over the same rays.
    const double rays = kSides * rays_along_;
    const bool mostly_open = 2 * space.shut <= rays;
    add_rays(task, position, mostly_open, space);
    space.vectors.assign(coefficients * numbers, 0.0f);
    for (std::size_t o = 0; o < coefficients; ++o) {
        const std::span<const float> blocked = space.blocked.row(o), all = space.all.row(o);
        for (std::size_t i = 0; i < direct; ++i) {
            const float whole = mostly_open ? (i == o ? 1.0f : 0.0f) : all[i];
            space.vectors[o * numbers + i] = whole - blocked[i];
        }
        std::copy_n(space.reflected.row(o).begin(), numbers - direct, &space.vectors[o * numbers + direct]);
    }
    space.seen = {space.vectors, static_cast<float>(space.backs / rays)};
    if (!task.cells.empty())
        space.seen.distances =
            space.visibility.distances(rays, kVisibilityCells * task.cells[position].width);
}

float ProbeTracer::look(const glm::vec3& d, Space& space) const {
    const int bands = std::max(layout_.sky.order, layout_.order);
    evaluate_sh(bands, d, std::span(space.basis).first(static_cast<std::size_t>(coefficient_count(bands))));
    return static_cast<float>(
        6 * std::numbers::pi /
        (kSides * rays_along_ * static_cast<double>(std::abs(d.x) + std::abs(d.y) + std::abs(d.z))));
}

void ProbeTracer::add_direction(float weight, const Space& space, OuterSums& sums) const {
    const OuterSums::Room room = sums.add();
    for (std::size_t o = 0; o < room.weights.size(); ++o)
        room.weights[o] = weight * space.basis[o];
    std::copy_n(space.basis.begin(), layout_.direct(), room.values.begin());
}

void ProbeTracer::add_hit(const Hit& hit, const Task& task, std::size_t position, Space& space) const {
    const glm::vec3& from = task.positions[position];
    const std::vector<glm::vec3>& positions = plan_.receivers().positions;
    const glm::uvec3& corners = plan_.scene.surfaces().corners(hit.triangle);
    const glm::vec3 way = (1 - hit.u - hit.v) * (positions[corners.x] - from) +
                          hit.u * (positions[corners.y] - from) + hit.v * (positions[corners.z] - from);
    const float distance = glm::length(way);
    if (!(distance > 0)) // on a surface
        return;
    const glm::vec3 d = way / distance;
    const float weight = hit.weight * look(d, space);
    space.shut += static_cast<double>(hit.weight);
    add_direction(weight, space, space.blocked);
    if (!task.cells.empty())
        space.visibility.add_hit(way,
                                 glm::cross(positions[corners.y] - positions[corners.x],
                                            positions[corners.z] - positions[corners.x]),
                                 hit.weight);
    if (hit.back && !plan_.scene.surfaces().two_sided(hit.triangle))
        space.backs += static_cast<double>(hit.weight);
    else if (!sky_.empty() || !lamps_.empty())
        add_reflected(hit, weight, space);
}

/// Adds all rays, independent of their hits. If most directions are open the sum is not needed.
void ProbeTracer::add_rays(const Task& task, std::size_t position, bool mostly_open, Space& space) const {
    if (mostly_open)
        return;
    for (int s = 0; s < kSides; ++s)
        for (int first = 0; first < rays_along_; first += kChunk) {
            const int rays = std::min(kChunk, rays_along_ - first);
            generate_directions(
                rays == kChunk ? whole_ : last_, sobol_offset(static_cast<std::uint32_t>(first)),
                receiver_seed(static_cast<std::uint32_t>(position) * kSides + static_cast<std::uint32_t>(s),
                              task.seed),
                tangent_frame(side(s)), space.directions);
            for (std::size_t r = 0; r < static_cast<std::size_t>(rays); ++r) {
                const glm::vec3 d(space.directions.x[r], space.directions.y[r], space.directions.z[r]);
                add_direction(look(d, space), space, space.all);
            }
        }
}

/// Interpolates exit light of the front of a surface, if each receiver has one reflectance.
void ProbeTracer::mix_reflected(const Hit& hit, std::span<float> to) const {
    const std::size_t sky = layout_.sky.dimension() - layout_.direct(),
                      lamps = lamps_.empty() ? 0 : layout_.lamps.dimension();
    const glm::vec3 barycentrics(1 - hit.u - hit.v, hit.u, hit.v);
    const glm::uvec3& corners = plan_.scene.surfaces().corners(hit.triangle);
    const auto mix = [&](const std::vector<float>& from, std::size_t stride, float* values) {
        if (stride > 0)
            mix_rows(barycentrics,
                     {&from[corners.x * stride], &from[corners.y * stride], &from[corners.z * stride]},
                     stride, values);
    };
    mix(sky_, sky, to.data());
    mix(lamps_, lamps, to.data() + sky);
}

/// Adds light from the hit surface in the direction of `space.basis`.
void ProbeTracer::add_reflected(const Hit& hit, float weight, Space& space) const {
    const Surfaces& surfaces = plan_.scene.surfaces();
    const TransportReceivers& receivers = *plan_.transport;
    const std::size_t sky = layout_.sky.dimension() - layout_.direct(),
                      lamps = lamps_.empty() ? 0 : layout_.lamps.dimension();
    const OuterSums::Room room = space.reflected.add();
    for (std::size_t o = 0; o < room.weights.size(); ++o)
        room.weights[o] = weight * space.basis[o];
    if (!reflectance_.empty() && !hit.back)
        return mix_reflected(hit, room.values);
    std::ranges::fill(room.values, 0.0f);
    const glm::vec3 barycentrics(1 - hit.u - hit.v, hit.u, hit.v);
    std::optional<Scattering> scattering;
    if (reflectance_.empty())
        scattering = surfaces.scattering({hit.triangle, {hit.u, hit.v}, hit.footprint});
    const auto add = [&](std::uint32_t receiver, float share, const glm::vec3& factor) {
        if (receiver == kNoReceiver || factor == glm::vec3(0))
            return;
        const auto add_colors = [&](const std::vector<float>& from, std::size_t stride, int channels,
                                    float* to) {
            const std::size_t count = stride / static_cast<std::size_t>(channels);
            for (int c = 0; c < channels; ++c)
                add_scaled(share * factor[c], &from[receiver * stride + static_cast<std::size_t>(c) * count],
                           count, to + static_cast<std::size_t>(c) * count);
        };
        if (sky > 0)
            add_colors(sky_, sky, plan_.channels, room.values.data());
        if (lamps > 0)
            add_colors(lamps_, lamps, layout_.lamps.channels(), room.values.data() + sky);
    };
    for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t front = surfaces.corners(hit.triangle)[corner], back = receivers.back_of(front);
        const std::uint32_t near = hit.back ? back : front, far = hit.back ? front : back;
        add(near, barycentrics[corner], scattering ? scattering->reflected : glm::vec3(1));
        if (scattering)
            add(far, barycentrics[corner], scattering->transmitted);
    }
}

std::size_t ProbeTracer::add_lamps(const Task& task, std::size_t position, Space& space) const {
    const std::size_t numbers = layout_.numbers(), first = layout_.sky.dimension(),
                      channels = static_cast<std::size_t>(layout_.lamps.channels()),
                      stride = layout_.lamps.dimension() / channels;
    std::size_t rays = 0;
    for (std::size_t k = 0; k < plan_.lamps.size(); ++k) {
        const Lamp& lamp = plan_.lamps[k];
        if (plan_.options.lamps.mode != LampMode::all)
            continue;
        std::array<double, kMaxIncidentOrder * kMaxIncidentOrder> basis{};
        const auto take = [&](const glm::dvec3& towards, const glm::dvec3& irradiance) {
            evaluate_sh(layout_.order, towards, std::span(basis).first(layout_.coefficients()));
            for (std::size_t o = 0; o < layout_.coefficients(); ++o)
                for (std::size_t c = 0; c < channels; ++c)
                    space.vectors[o * numbers + first + c * stride + k] +=
                        static_cast<float>(basis[o] * irradiance[static_cast<int>(c)]);
        };
        LampReceiver receiver{task.positions[position], glm::vec3(0, 0, 1), task.positions[position],
                              receiver_seed(static_cast<std::uint32_t>(position), task.seed + k)};
        rays += take_lights(plan_.scene, lamp, receiver, plan_.options.lamps.radius, plan_.options.lamps.rays,
                            take);
        if (shining_[k].all().empty())
            continue;
        for (const float up : {1.0f, -1.0f}) {
            receiver.normal = glm::vec3(0, 0, up);
            rays += shining_[k].take_light(receiver, std::max(1, plan_.options.lamps.rays / 2), take);
        }
    }
    return rays;
}

} // namespace prt

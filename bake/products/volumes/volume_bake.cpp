// Bakes probes: light bounces between vertices, then light is measured at probes and at points between them,
// and probes are fitted so that interpolation matches the points.

#include "prt/bake/volume_bake.h"

#include "bake/pipeline/record.h"
#include "bake/plan/available_memory.h"
#include "bake/plan/check_options.h"
#include "bake/plan/memory.h"
#include "bake/plan/transfer_terms.h"
#include "bake/products/volumes/light_error.h"
#include "bake/products/volumes/place_bricks.h"
#include "bake/products/volumes/probe_fit.h"
#include "bake/products/volumes/probe_states.h"
#include "bake/products/volumes/probe_tracer.h"
#include "bake/products/volumes/refine_bricks.h"
#include "bake/trace/scrambles.h"
#include "bake/tracers/make_tracer.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/support/stopwatch.h"

#include <fmt/core.h>

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

namespace prt {
namespace {

void check_volume_options(const VolumeOptions& volume, const BakeOptions& options) {
    check_options(options);
    if (volume.order < 2 || volume.order > kMaxIncidentOrder)
        throw Error(fmt::format("the order of the incident light of a volume must be in 2..{}, not {}",
                                kMaxIncidentOrder, volume.order));
    if (volume.rays < 0 || volume.rays > kMaxRays)
        throw Error(
            fmt::format("the number of rays per probe must be in 0..{}, not {}", kMaxRays, volume.rays));
    if (volume.probes == 0 && !(volume.spacing > 0 && volume.spacing <= kFarthestVertex))
        throw Error(fmt::format("the probe spacing of a volume cannot be {:g} m", volume.spacing));
    if (!(volume.error >= 0 && volume.error < 1))
        throw Error(
            fmt::format("the error of a volume must be at least 0 and less than 1, not {:g}", volume.error));
    if (volume.error > 0 && volume.probes > 0)
        throw Error("the error of a volume determines its number of probes; give the probe spacing in "
                    "metres instead of the number of probes");
    if (volume.fit_points && !(*volume.fit_points >= 0 && *volume.fit_points <= 100))
        throw Error("the number of fit points per cell must be in 0..100");
}

/// Number of points per cell for finding where light has errors.
constexpr double kSurveyed = 0.25;
/// Number of points of the fit that are kept in memory.
constexpr std::size_t kPointsAtOnce = 2048;
/// Share of a probe's rays that goes to points of the fit. Half of the rays had larger errors by noise.
constexpr double kFitShare = 0.25;

/// Replaces the values that depend on the bake.
VolumeOptions completed(VolumeOptions volume, const BakeOptions& options) {
    if (volume.rays == 0)
        volume.rays = options.rays;
    if (!volume.fit_points)
        volume.fit_points = volume.rays >= kRaysWorthAFit ? 1 : 0;
    return volume;
}

bool is_fitted(const VolumeOptions& volume) {
    return *volume.fit_points > 0;
}

int rays_of_probe(const VolumeOptions& volume) {
    return is_fitted(volume) ? static_cast<int>(std::ceil((1 - kFitShare) * volume.rays)) : volume.rays;
}

int rays_of_point(const VolumeOptions& volume) {
    return static_cast<int>(std::ceil(kFitShare * volume.rays / *volume.fit_points));
}

/// Bytes per probe: its values, sums of its points, and a copy in parts. Calculated, not measured.
double bytes_of_probe(const VolumeOptions& volume, std::size_t numbers) {
    return sizeof(float) * static_cast<double>(numbers) * coefficient_count(volume.order) *
           (2.2 + (is_fitted(volume) ? 1 : 0));
}

void check_room(const VolumeOptions& volume, double probes, std::size_t numbers, double there) {
    const double needed = bytes_of_probe(volume, numbers) * probes;
    if (there > 0 && needed > there)
        throw Error(fmt::format("{:.3g} probes with {} numbers each need about {:.2g} GB of memory, but only "
                                "{:.2g} GB are available; use a larger spacing or a lower order",
                                probes, numbers * static_cast<std::size_t>(coefficient_count(volume.order)),
                                needed * 1e-9, there * 1e-9));
}

/// Maximum number of bricks: the number of probes that a brick adds is at least its number of cells.
std::size_t max_bricks(const VolumeOptions& volume, std::size_t numbers, double there) {
    constexpr double kCells = kBrickCells * kBrickCells * kBrickCells;
    return there > 0 ? static_cast<std::size_t>(there / (kCells * bytes_of_probe(volume, numbers))) + 1
                     : std::size_t{1} << 24;
}

/// Points spread over the cells of a volume, with an equal number in each brick; points outside of its bounds
/// are omitted.
struct PointsBetween {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> bricks; ///< brick of each point, in ascending order
};

/// Creates `each` points per cell.
PointsBetween points_between(const VolumeGrid& grid, const Bounds& bounds, double each, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    PointsBetween points;
    double owed = 0;
    for (std::uint32_t b = 0; b < grid.bricks.size(); ++b) {
        const VolumeBrick& brick = grid.bricks[b];
        owed += each * kBrickCells * kBrickCells * kBrickCells;
        const float side = grid.spacing * static_cast<float>(kBrickCells << brick.level);
        const glm::vec3 least = position_of(grid, kBrickCells * brick.position);
        for (; owed >= 1; owed -= 1) {
            const float x = unit(random), y = unit(random), z = unit(random);
            const glm::vec3 point = least + side * glm::vec3(x, y, z);
            if (glm::clamp(point, bounds.low, bounds.high) == point) {
                points.positions.push_back(point);
                points.bricks.push_back(b);
            }
        }
    }
    return points;
}

/// Splits vectors [positions][coefficients][numbers] into the terms of a file.
Transfer split_into_terms(const IncidentLayout& layout, const BakePlan& plan,
                          std::span<const float> vectors) {
    const std::size_t numbers = layout.numbers(), rows = vectors.size() / numbers;
    const auto term = [&](std::size_t first, TransferLayout of_part) {
        Transfer transfer = zero_transfer(std::move(of_part), rows);
        const std::size_t count = transfer.dimension();
        for (std::size_t r = 0; r < rows; ++r)
            std::copy_n(&vectors[r * numbers + first], count, &transfer.vectors[r * count]);
        return transfer;
    };
    const int order = layout.sky.order;
    Transfer all = term(0, layout_of_one(order, 1, TermKind::direct));
    if (layout.sky.terms.size() > 1)
        all = joined(
            all, narrowed(term(layout.direct(), layout_of_one(order, plan.channels, TermKind::indirect))));
    if (!plan.lamps.empty())
        all = with_lamps(all, term(layout.sky.dimension(), layout.lamps), plan.lamps);
    return all;
}

/// Bakes a volume in steps.
class VolumeBaker {
public:
    VolumeBaker(const Scene& scene, const VolumeOptions& volume, const BakeOptions& options)
        : scene_(scene), volume_(completed(volume, options)), options_(options),
          media_(choose_media(scene, options)), traced_(trace_scene(scene, media_, options)),
          plan_(plan_bake(traced_, media_, options)), tracer_(make_tracer(traced_, options.tracer)) {}

    VolumeBake run(const Progress& progress) {
        BakedVolume& baked = result_.volume;
        check_memory(plan_);
        const double there = available_memory(options_.memory.limit);
        check_room(volume_, static_cast<double>(volume_.probes), plan_.numbers(), there);
        baked.grid = place_bricks(scene_, volume_, max_bricks(volume_, plan_.numbers(), there));
        baked.order = volume_.order;
        check_room(volume_, static_cast<double>(probes_of(baked.grid).size()), plan_.numbers(), there);
        ProbeTracer tracer = probe_tracer(progress.range(0, 0.2));
        ProbeStates states = measured(tracer, there, progress.range(0.2, 0.5));
        count_probes(states);
        const ProbeVectors vectors = states.vectors();
        const VolumeProbes probes = probes_of(baked.grid);
        fill_invalid(probes, states.invalid_mask(), vectors);
        settle_hanging(baked.grid, probes, vectors);
        if (is_fitted(volume_))
            fit(tracer, vectors, progress.range(0.5, 1));
        finish(tracer, states.values);
        progress.update(1);
        return std::move(result_);
    }

    PlacedLight at(std::span<const glm::vec3> positions, const Progress& progress) {
        ProbeTracer tracer = probe_tracer(progress.range(0, 0.4));
        const std::size_t stride = tracer.layout().coefficients() * tracer.layout().numbers();
        std::vector<float> values(positions.size() * stride);
        PlacedLight light;
        light.backs.resize(positions.size());
        const ProbeTracer::Task task{.positions = positions, .rays = volume_.rays, .seed = options_.seed};
        tracer.trace(task, progress.range(0.4, 1), [&](std::size_t p, const ProbeView& seen) {
            std::ranges::copy(seen.vectors, &values[p * stride]);
            light.backs[p] = seen.backs;
        });
        light.transfer = split_into_terms(tracer.layout(), plan_, values);
        return light;
    }

private:
    VolumeStatistics& statistics() { return result_.statistics; }

    ProbeTracer probe_tracer(const Progress& progress) {
        BounceSources sources = bounce_sources(plan_, *tracer_, progress);
        statistics().rays = sources.rays;
        statistics().seconds.sources = watch_.seconds();
        bounces_ = sources.bounces;
        return {plan_, tracer_->rays(), std::move(sources), volume_.order};
    }

    /// Places the final bricks and measures their probes.
    ProbeStates measured(ProbeTracer& tracer, double room, const Progress& progress) {
        VolumeGrid& grid = result_.volume.grid;
        const ProbeTask task{traced_, tracer, rays_of_probe(volume_), options_.seed, options_.threads};
        if (volume_.error > 0)
            grid = with_finer_levels(std::move(grid));
        ProbeStates states = measure_probes(task, grid, probes_of(grid), {}, progress.range(0, 0.4));
        for (int round = 1; volume_.error > 0 && round <= kMaxRefinements; ++round) {
            const VolumeGrid finer = refined(tracer, states, round);
            if (finer == grid)
                break;
            const VolumeProbes probes = probes_of(finer);
            check_room(volume_, static_cast<double>(probes.size()), plan_.numbers(), room);
            states = measure_probes(task, finer, probes, std::move(states),
                                    progress.range(0.4 * round, 0.4 * round + 0.2));
            grid = finer;
        }
        result_.volume.visibility = states.visibility(grid);
        grid = without_unused_levels(std::move(grid));
        return states;
    }

    /// Returns the grid with bricks split where light has the largest errors, measured at points between
    /// probes.
    VolumeGrid refined(ProbeTracer& tracer, const ProbeStates& states, int round) {
        const VolumeGrid& grid = result_.volume.grid;
        const VolumeLookup lookup(grid, states.visibility(grid));
        const PointsBetween points = points_between(grid, volume_bounds(scene_, volume_), kSurveyed,
                                                    options_.seed + static_cast<std::uint64_t>(round));
        const LightError error_of(tracer.layout());
        std::vector<BrickError> of_points(points.positions.size());
        for (std::size_t begin = 0; begin < points.positions.size(); begin += kPointsAtOnce) {
            const std::size_t count = std::min(kPointsAtOnce, points.positions.size() - begin);
            const PointsSeen seen =
                see_twice(tracer, std::span(points.positions).subspan(begin, count),
                          options_.seed + static_cast<std::uint64_t>(round) * kSecondScramble + begin);
            parallel_for(count, 16, options_.threads, [&](std::size_t first, std::size_t last) {
                for (std::size_t p = first; p < last; ++p)
                    if (seen.free[p])
                        of_points[begin + p] =
                            error_of(lookup.find(points.positions[begin + p]), states, seen.of(p));
            });
        }
        std::vector<BrickError> errors(grid.bricks.size());
        for (std::size_t p = 0; p < of_points.size(); ++p) {
            const std::uint32_t b = points.bricks[p];
            errors[b].add(std::pow(8.0, grid.bricks[b].level), of_points[p]);
        }
        return with_split_bricks(grid, bricks_to_split(grid, errors, volume_.error));
    }

    /// Light at points from half of a probe's rays, and from an equal number of other rays.
    struct PointsSeen {
        std::size_t stride;
        std::array<std::vector<float>, 2> vectors;
        std::vector<char> free;

        std::array<std::span<const float>, 2> of(std::size_t p) const {
            return {std::span(vectors[0]).subspan(p * stride, stride),
                    std::span(vectors[1]).subspan(p * stride, stride)};
        }
    };

    PointsSeen see_twice(ProbeTracer& tracer, std::span<const glm::vec3> positions, std::uint64_t seed) {
        PointsSeen points{tracer.layout().coefficients() * tracer.layout().numbers(), {}, {}};
        points.free.assign(positions.size(), 1);
        for (std::size_t half = 0; half < 2; ++half) {
            points.vectors[half].resize(positions.size() * points.stride);
            const ProbeTracer::Task task{.positions = positions,
                                         .rays = (rays_of_probe(volume_) + 1) / 2,
                                         .seed = seed ^ (half << 40)};
            tracer.trace(task, {}, [&](std::size_t p, const ProbeView& seen) {
                std::ranges::copy(seen.vectors, &points.vectors[half][p * points.stride]);
                if (seen.backs > kMaxBackShare)
                    points.free[p] = 0;
            });
        }
        return points;
    }

    void count_probes(const ProbeStates& states) {
        VolumeStatistics::Probes& counts = statistics().probes;
        counts.all = states.size();
        counts.moved = static_cast<std::size_t>(std::ranges::count(states.moved, 1));
        counts.invalid = static_cast<std::size_t>(std::ranges::count(states.invalid, 1));
        counts.hanging = probes_of(result_.volume.grid).hanging.size();
        counts.bricks = result_.volume.grid.bricks.size();
        if (counts.invalid == counts.all)
            throw Error("all probes of the volume are inside solid geometry; use other bounds or "
                        "double-sided materials");
        statistics().seconds.probes = watch_.seconds() - statistics().seconds.sources;
    }

    void fit(ProbeTracer& tracer, const ProbeVectors& vectors, const Progress& progress) {
        const VolumeGrid& grid = result_.volume.grid;
        const VolumeLookup lookup(grid, result_.volume.visibility);
        const std::vector<glm::vec3> positions =
            points_between(grid, volume_bounds(scene_, volume_), *volume_.fit_points, options_.seed)
                .positions;
        ProbeFit probe_fit(grid, lookup.probes(), vectors.stride);
        for (std::size_t begin = 0; begin < positions.size(); begin += kPointsAtOnce) {
            const std::size_t count = std::min(kPointsAtOnce, positions.size() - begin);
            add_points(tracer, lookup, std::span(positions).subspan(begin, count), begin, probe_fit);
            progress.update(0.7 * static_cast<double>(begin + count) / static_cast<double>(positions.size()));
        }
        const ProbeFit::Errors errors = probe_fit.solve(vectors, options_.threads, progress.range(0.7, 1));
        settle_hanging(grid, lookup.probes(), vectors);
        statistics().probes.fit_points = probe_fit.points();
        statistics().fit_before = errors.before;
        statistics().fit_after = errors.after;
        statistics().seconds.fit =
            watch_.seconds() - statistics().seconds.sources - statistics().seconds.probes;
    }

    /// Measures points; `first` is the index of the first one.
    void add_points(ProbeTracer& tracer, const VolumeLookup& lookup, std::span<const glm::vec3> positions,
                    std::size_t first, ProbeFit& probe_fit) {
        const std::size_t stride = tracer.layout().coefficients() * tracer.layout().numbers();
        std::vector<float> values(positions.size() * stride);
        std::vector<char> kept(positions.size());
        tracer.trace({.positions = positions,
                      .rays = rays_of_point(volume_),
                      .seed = options_.seed + kSecondScramble + first},
                     {}, [&](std::size_t p, const ProbeView& seen) {
                         std::ranges::copy(seen.vectors, &values[p * stride]);
                         kept[p] = seen.backs <= kMaxBackShare;
                     });
        std::vector<VolumeCorners> corners;
        for (std::size_t p = 0; p < positions.size(); ++p) {
            if (!kept[p])
                continue;
            std::copy_n(&values[p * stride], stride, &values[corners.size() * stride]);
            corners.push_back(lookup.find(positions[p]));
        }
        probe_fit.add(corners, std::span(values).first(corners.size() * stride), options_.threads);
    }

    void finish(const ProbeTracer& tracer, std::span<const float> values) {
        VolumeStatistics& s = statistics();
        BakedTransfer& baked = result_.volume.baked;
        baked.transfer = split_into_terms(tracer.layout(), plan_, values);
        const std::vector<float> areas(baked.transfer.receivers(), 1.0f);
        s.rounding_error = float16_rounding_error(baked.transfer, areas);
        baked.record = {.bounces = bounces_,
                        .endless = plan_.bounces == kEndlessBounces,
                        .rays = volume_.rays,
                        .seed = options_.seed,
                        .method = tracer_->rays().method(),
                        .backend = tracer_->rays().backend(),
                        .receivers = receivers_id(scene_)};
        if (options_.memory.storage == TransferStorage::float16)
            check_float16(s.rounding_error);
        baked.storage = options_.memory.storage.value_or(s.rounding_error < 1e-3 ? TransferStorage::float16
                                                                                 : TransferStorage::float32);
        s.rays += tracer.rays();
        s.device = tracer_->rays().device();
        s.notices.insert(s.notices.begin(), plan_.notices.begin(), plan_.notices.end());
        s.seconds.all = watch_.seconds();
    }

    Stopwatch watch_;
    const Scene& scene_;
    const VolumeOptions volume_;
    const BakeOptions& options_;
    Media media_;
    TraceScene traced_;
    BakePlan plan_;
    std::unique_ptr<Tracer> tracer_;
    int bounces_ = 0;
    VolumeBake result_;
};

} // namespace

VolumeBake bake_volume(const Scene& scene, const VolumeOptions& volume, const BakeOptions& options,
                       const Progress& progress) {
    check_volume_options(volume, options);
    return VolumeBaker(scene, volume, options).run(progress);
}

PlacedLight bake_positions(const Scene& scene, std::span<const glm::vec3> positions, int order,
                           const BakeOptions& options, const Progress& progress) {
    const VolumeOptions volume{.order = order};
    check_volume_options(volume, options);
    return VolumeBaker(scene, volume, options).at(positions, progress);
}

} // namespace prt

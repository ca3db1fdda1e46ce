// Bakes probes: light is bounced between vertices, then probes and points between them see what there is, and
// probes are moved so that interpolation comes nearest to that.

#include "prt/volume_bake.h"

#include "available_memory.h"
#include "bake_options.h"
#include "memory.h"
#include "parts.h"
#include "prt/error_measures.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"
#include "record.h"
#include "trace/scrambles.h"
#include "volume/place_bricks.h"
#include "volume/probe_fit.h"
#include "volume/probe_places.h"
#include "volume/probe_tracer.h"

#include <fmt/core.h>

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

namespace prt {
namespace {

/// A place is inside of something where more of its rays end at backs of surfaces that have no light there.
constexpr float kMostBacks = 0.25f;

void check_volume_options(const VolumeOptions& volume, const BakeOptions& options) {
    check_options(options);
    if (options.tracer.method == BakeMethod::raster)
        throw Error("method raster draws depth maps for vertices: use method trace for volumes");
    if (options.target_error)
        throw Error("an error to reach is one of vertices: give probes a number of rays");
    if (volume.order < 2 || volume.order > kMostIncidentOrder)
        throw Error(fmt::format("incident light of volumes has 2 to {} bands, not {}", kMostIncidentOrder,
                                volume.order));
    if (volume.probes == 0 && !(volume.spacing > 0 && volume.spacing <= kFarthestVertex))
        throw Error(fmt::format("probes of a volume cannot be {:g} m apart", volume.spacing));
    if (!(volume.fit_points >= 0 && volume.fit_points <= 100))
        throw Error("points of the fit are 0 to 100 for each probe");
}

/// Bytes that a probe takes: its values, those of its points, and a copy in parts. Counted, not measured.
double bytes_of_probe(const VolumeOptions& volume, std::size_t numbers) {
    return sizeof(float) * static_cast<double>(numbers) * coefficient_count(volume.order) *
           (2.2 + volume.fit_points);
}

void check_room(const VolumeOptions& volume, double probes, std::size_t numbers, double there) {
    const double needed = bytes_of_probe(volume, numbers) * probes;
    if (there > 0 && needed > there)
        throw Error(fmt::format("{:.3g} probes of {} numbers each need about {:.2g} GB of memory, and there "
                                "are {:.2g} GB: set them further apart, or take a lower order",
                                probes, numbers * static_cast<std::size_t>(coefficient_count(volume.order)),
                                needed * 1e-9, there * 1e-9));
}

/// Bricks that there may be: each has at least as many probes of its own as it has cells.
std::size_t most_bricks(const VolumeOptions& volume, std::size_t numbers, double there) {
    constexpr double kCells = kBrickCells * kBrickCells * kBrickCells;
    return there > 0 ? static_cast<std::size_t>(there / (kCells * bytes_of_probe(volume, numbers))) + 1
                     : std::size_t{1} << 24;
}

/// Points all over the cells of a volume, as many in each brick, but for those out of its bounds.
std::vector<glm::vec3> points_between(const VolumeGrid& grid, const Bounds& bounds, double each,
                                      std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<glm::vec3> points;
    double owed = 0;
    for (const VolumeBrick& brick : grid.bricks) {
        owed += each * kBrickCells * kBrickCells * kBrickCells;
        const float side = grid.spacing * static_cast<float>(kBrickCells << brick.level);
        const glm::vec3 least = position_of(grid, kBrickCells * brick.place);
        for (; owed >= 1; owed -= 1) {
            const float x = unit(random), y = unit(random), z = unit(random);
            const glm::vec3 point = least + side * glm::vec3(x, y, z);
            if (glm::clamp(point, bounds.low, bounds.high) == point)
                points.push_back(point);
        }
    }
    return points;
}

/// Distances that are seen from the corner of a probe that was measured `way` off it.
std::array<float, 6> seen_from(std::array<float, 6> distances, const glm::vec3& way) {
    for (int a = 0; a < 3; ++a) {
        float& low = distances[static_cast<std::size_t>(2 * a)];
        float& high = distances[static_cast<std::size_t>(2 * a + 1)];
        low = std::max(low - way[a], 0.02f * low);
        high = std::max(high + way[a], 0.02f * high);
    }
    return distances;
}

/// Vectors [places][coefficients][numbers] taken apart into what a file holds.
Transfer in_parts_of(const IncidentLayout& layout, const BakePlan& plan, std::span<const float> vectors) {
    const std::size_t numbers = layout.numbers(), rows = vectors.size() / numbers;
    const auto part = [&](std::size_t first, TransferLayout of_part) {
        Transfer transfer = zero_transfer(std::move(of_part), rows);
        const std::size_t count = transfer.dimension();
        for (std::size_t r = 0; r < rows; ++r)
            std::copy_n(&vectors[r * numbers + first], count, &transfer.vectors[r * count]);
        return transfer;
    };
    const int order = layout.sky.order;
    Transfer all = part(0, layout_of_one(order, 1, PartKind::direct));
    if (layout.sky.parts.size() > 1)
        all = joined(
            all, narrowed(part(layout.direct(), layout_of_one(order, plan.channels, PartKind::indirect))));
    if (!plan.lamps.empty())
        all = with_lamps(all, part(layout.sky.dimension(), layout.lamps), plan.lamps);
    return all;
}

/// A volume on its way.
class VolumeBaker {
public:
    VolumeBaker(const Scene& scene, const VolumeOptions& volume, const BakeOptions& options)
        : scene_(scene), volume_(volume), options_(options), media_(choose_media(scene, options)),
          traced_(trace_scene(scene, media_, options)), plan_(plan_bake(traced_, media_, options)),
          tracer_(make_tracer(traced_, options.tracer)) {}

    VolumeBake run(const Progress& progress) {
        BakedVolume& baked = result_.volume;
        check_memory(plan_);
        const double there = available_memory(options_.memory.limit);
        check_room(volume_, static_cast<double>(volume_.probes), plan_.numbers(), there);
        baked.grid = place_bricks(scene_, volume_, most_bricks(volume_, plan_.numbers(), there));
        baked.order = volume_.order;
        const VolumeProbes probes = probes_of(baked.grid);
        check_room(volume_, static_cast<double>(probes.size()), plan_.numbers(), there);
        ProbeTracer tracer = probe_tracer(progress.part(0, 0.2));
        const std::size_t stride = tracer.layout().coefficients() * tracer.layout().numbers();
        std::vector<float> values = trace_probes(tracer, probes, stride, progress.part(0.2, 0.5));
        const ProbeVectors vectors{values, stride};
        fill_blind(probes, blind_, vectors);
        settle_hanging(baked.grid, probes, vectors);
        if (volume_.fit_points > 0)
            fit(tracer, vectors, progress.part(0.5, 1));
        finish(tracer, values);
        progress.update(1);
        return std::move(result_);
    }

    PlacedLight at(std::span<const glm::vec3> places, const Progress& progress) {
        ProbeTracer tracer = probe_tracer(progress.part(0, 0.4));
        const std::size_t stride = tracer.layout().coefficients() * tracer.layout().numbers();
        std::vector<float> values(places.size() * stride);
        PlacedLight light;
        light.backs.resize(places.size());
        tracer.trace({places, 1, options_.seed}, progress.part(0.4, 1),
                     [&](std::size_t p, const PlaceSeen& seen) {
                         std::ranges::copy(seen.vectors, &values[p * stride]);
                         light.backs[p] = seen.backs;
                     });
        light.transfer = in_parts_of(tracer.layout(), plan_, values);
        return light;
    }

private:
    VolumeStatistics& statistics() { return result_.statistics; }

    ProbeTracer probe_tracer(const Progress& progress) {
        BouncedSources sources = bounced_sources(plan_, *tracer_, progress);
        statistics().rays = sources.rays;
        statistics().seconds.sources = watch_.seconds();
        bounces_ = sources.bounces;
        return {plan_, *tracer_, std::move(sources), volume_.order};
    }

    std::vector<float> trace_probes(ProbeTracer& tracer, const VolumeProbes& probes, std::size_t stride,
                                    const Progress& progress) {
        const VolumeGrid& grid = result_.volume.grid;
        std::vector<float> values(probes.size() * stride);
        std::vector<glm::vec3> corners;
        std::vector<float> cells;
        for (std::size_t p = 0; p < probes.size(); ++p) {
            corners.push_back(position_of(grid, probes.corners[p]));
            cells.push_back(grid.spacing * static_cast<float>(1 << probes.levels[p]));
        }
        const std::vector<glm::vec3> places = free_places(traced_, corners, cells, options_.threads);
        std::vector<char> blind(places.size());
        std::vector<ProbeSight>& sights = result_.volume.sights;
        sights.resize(places.size());
        const float most = kSightCells * grid.spacing * static_cast<float>(1 << kMostBrickLevel);
        tracer.trace({places, most, options_.seed}, progress, [&](std::size_t p, const PlaceSeen& seen) {
            std::ranges::copy(seen.vectors, &values[p * stride]);
            blind[p] = seen.backs > kMostBacks;
            sights[p] = blind[p] ? ProbeSight{}
                                 : sight_of(seen_from(seen.distances, places[p] - corners[p]), cells[p]);
        });
        blind_.assign(blind.begin(), blind.end());
        VolumeStatistics::Probes& counts = statistics().probes;
        counts.all = places.size();
        for (std::size_t p = 0; p < places.size(); ++p)
            counts.moved += places[p] != corners[p] ? 1 : 0;
        counts.blind = static_cast<std::size_t>(std::ranges::count(blind_, true));
        counts.hanging = probes.hanging.size();
        counts.bricks = grid.bricks.size();
        if (counts.blind == counts.all)
            throw Error("no probe of the volume is in free space: all see backs of surfaces. Choose other "
                        "bounds, or let materials be double-sided");
        statistics().seconds.probes = watch_.seconds() - statistics().seconds.sources;
        return values;
    }

    void fit(ProbeTracer& tracer, const ProbeVectors& vectors, const Progress& progress) {
        const VolumeGrid& grid = result_.volume.grid;
        const VolumeLookup lookup(grid, result_.volume.sights);
        const std::vector<glm::vec3> places =
            points_between(grid, volume_bounds(scene_, volume_), volume_.fit_points, options_.seed);
        FitPoints points;
        points.vectors.resize(places.size() * vectors.stride);
        std::vector<char> kept(places.size());
        tracer.trace({places, 1, options_.seed + kSecondScramble}, progress.part(0, 0.7),
                     [&](std::size_t p, const PlaceSeen& seen) {
                         std::ranges::copy(seen.vectors, &points.vectors[p * vectors.stride]);
                         kept[p] = seen.backs <= kMostBacks;
                     });
        std::size_t count = 0;
        for (std::size_t p = 0; p < places.size(); ++p) {
            if (!kept[p])
                continue;
            points.corners.push_back(lookup.find(places[p]));
            std::copy_n(&points.vectors[p * vectors.stride], vectors.stride,
                        &points.vectors[count++ * vectors.stride]);
        }
        points.vectors.resize(count * vectors.stride);
        statistics().probes.fit_points = count;
        statistics().fit_before = error_at(points, vectors);
        fit_probes(grid, lookup.probes(), points, vectors, options_.threads, progress.part(0.7, 1));
        settle_hanging(grid, lookup.probes(), vectors);
        statistics().fit_after = error_at(points, vectors);
        statistics().seconds.fit =
            watch_.seconds() - statistics().seconds.sources - statistics().seconds.probes;
    }

    void finish(const ProbeTracer& tracer, std::span<const float> values) {
        VolumeStatistics& s = statistics();
        BakedTransfer& baked = result_.volume.baked;
        baked.transfer = in_parts_of(tracer.layout(), plan_, values);
        const std::vector<float> areas(baked.transfer.receivers(), 1.0f);
        s.rounding_error = float16_rounding_error(baked.transfer, areas);
        baked.record = {.bounces = bounces_,
                        .endless = plan_.bounces == kEndlessBounces,
                        .rays = options_.rays,
                        .seed = options_.seed,
                        .method = tracer_->method(),
                        .backend = tracer_->backend(),
                        .receivers = receivers_id(scene_)};
        baked.storage = options_.memory.storage.value_or(s.rounding_error < 1e-3 ? TransferStorage::float16
                                                                                 : TransferStorage::float32);
        s.rays += tracer.rays();
        s.device = tracer_->device();
        s.notices.insert(s.notices.begin(), plan_.notices.begin(), plan_.notices.end());
        s.seconds.all = watch_.seconds();
    }

    Stopwatch watch_;
    const Scene& scene_;
    const VolumeOptions& volume_;
    const BakeOptions& options_;
    Media media_;
    TraceScene traced_;
    BakePlan plan_;
    std::unique_ptr<Tracer> tracer_;
    std::vector<bool> blind_;
    int bounces_ = 0;
    VolumeBake result_;
};

} // namespace

VolumeBake bake_volume(const Scene& scene, const VolumeOptions& volume, const BakeOptions& options,
                       const Progress& progress) {
    check_volume_options(volume, options);
    return VolumeBaker(scene, volume, options).run(progress);
}

PlacedLight bake_places(const Scene& scene, std::span<const glm::vec3> places, int order,
                        const BakeOptions& options, const Progress& progress) {
    const VolumeOptions volume{.order = order};
    check_volume_options(volume, options);
    return VolumeBaker(scene, volume, options).at(places, progress);
}

} // namespace prt

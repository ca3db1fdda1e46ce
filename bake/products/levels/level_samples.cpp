// Spreads samples over a coarser level and finds the point of level 0 that each of them shows.

#include "bake/products/levels/level_surface.h"
#include "prt/core/error.h"
#include "runtime/core/support/parallel.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Number of samples for each receiver of the level, and for each receiver of level 0, whose detail the level
/// has to show.
constexpr std::size_t kSamplesOfReceiver = 16, kSamplesOfFinest = 4, kMaxLevelSamples = std::size_t{1} << 22;
/// Maximum root mean square distance of a level relative to the diagonal of level 0. Two crossed quads for a
/// tree have a tenth; a level that was moved next to its node has one or more.
constexpr double kTooFar = 0.25;

Scene with_shadows(Scene scene) {
    for (Material& material : scene.materials)
        material.casts_shadow = true;
    return scene;
}

ScenePart part_that_is_met(const Scene& scene, std::span<const std::size_t> primitives) {
    ScenePart part = scene_part(scene, primitives);
    part.scene = with_shadows(std::move(part.scene));
    return part;
}

/// Adds the interpolated values of the corners to `to`.
void add_shares(std::span<const float> values, const std::array<std::uint32_t, 3>& corners,
                const std::array<float, 3>& shares, std::span<double> to) {
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t c = 0; c < to.size(); ++c)
            to[c] += static_cast<double>(shares[i] * values[corners[i] * to.size() + c]);
}

} // namespace

PartSurface::PartSurface(const Scene& scene, std::span<const std::size_t> primitives, int threads)
    : part(part_that_is_met(scene, primitives)), traced(part.scene, {}, {.threads = threads}),
      receivers(without_back_sides(vertex_receivers(part.scene))) {}

std::vector<NearestPoint> FinestSurface::find(std::span<const glm::vec3> positions,
                                              std::span<const glm::vec3> normals,
                                              const Progress& progress) const {
    constexpr std::size_t kBlock = 256;
    std::vector<NearestPoint> nearest(positions.size());
    parallel_for(nearest.size(), kBlock, threads_, [&](std::size_t begin, std::size_t end) {
        progress.check();
        for (std::size_t i = begin; i < end; ++i)
            nearest[i] = positions_.find(positions[i], normals[i]);
    });
    return nearest;
}

std::array<std::uint32_t, 3> FinestSurface::corners(std::uint32_t triangle) const {
    const glm::uvec3& c = surface_.traced.surfaces().corners(triangle);
    return {surface_.part.receivers[c.x], surface_.part.receivers[c.y], surface_.part.receivers[c.z]};
}

SurfaceSamples samples_of(const PartSurface& level, std::size_t finest_receivers, std::uint64_t seed) {
    const std::size_t count = std::min(kMaxLevelSamples, std::max(kSamplesOfReceiver * level.points().size(),
                                                                  kSamplesOfFinest * finest_receivers));
    return sample_surfaces(level.traced.surfaces(), level.receivers, {.count = count, .seed = seed});
}

LevelSamples match_samples(const SurfaceSamples& samples, const PartSurface& level,
                           const FinestSurface& finest, const Progress& progress) {
    const std::vector<NearestPoint> nearest =
        finest.find(samples.receivers.positions, samples.receivers.normals, progress);
    LevelSamples result;
    result.diagonal = finest.diagonal();
    double squares = 0, area = 0;
    for (std::size_t s = 0; s < samples.size(); ++s) {
        const glm::uvec3& c = level.traced.surfaces().corners(samples.positions[s].triangle);
        LevelSample sample{{level.part.receivers[c.x], level.part.receivers[c.y], level.part.receivers[c.z]},
                           {},
                           samples.positions[s].shares(),
                           {},
                           samples.receivers.areas[s]};
        sample.from = sample.at; // shows nothing: its shares are zero
        if (const NearestPoint& position = nearest[s]; position.triangle != kNoTriangle) {
            sample.from = finest.corners(position.triangle);
            for (std::size_t i = 0; i < 3; ++i)
                sample.from_shares[i] = static_cast<float>(position.shares[i]);
            squares += static_cast<double>(sample.area) * position.distance * position.distance;
            area += static_cast<double>(sample.area);
            result.largest_distance = std::max(result.largest_distance, position.distance);
        }
        result.samples.push_back(sample);
    }
    result.rms_distance = area > 0 ? std::sqrt(squares / area) : 0;
    return result;
}

void check_distance(const LevelSamples& samples, const LeveledNode& node, const CoarserLevel& level) {
    if (samples.rms_distance > kTooFar * samples.diagonal)
        throw Error(
            fmt::format("{}, level {} of {}, is {:.3g} m away from this node, which is {:.3g} m in size; "
                        "a level must be at the position of its node",
                        level.name, level.level, node.name, samples.rms_distance, samples.diagonal));
}

LevelOutcome outcome_of(const Scene& scene, const LeveledNode& node, const CoarserLevel& level,
                        const LevelSamples& samples) {
    LevelOutcome outcome;
    outcome.name = level.name;
    outcome.of = node.name;
    outcome.level = level.level;
    for (const std::size_t p : level.primitives)
        outcome.triangles += scene.primitives[p].triangles.size();
    outcome.vertices = vertices_of(scene, level.primitives);
    outcome.samples = samples.samples.size();
    outcome.rms_distance = samples.rms_distance;
    outcome.largest_distance = samples.largest_distance;
    outcome.diagonal = samples.diagonal;
    return outcome;
}

void check_levels(const LeveledScene& scene, const LevelOptions& options, const Progress& progress) {
    for (const LeveledNode& node : scene.nodes) {
        const FinestSurface finest(scene, node, options.threads);
        for (const CoarserLevel& level : node.coarser) {
            const PartSurface surface(scene.scene, level.primitives, options.threads);
            const SurfaceSamples few = sample_surfaces(surface.traced.surfaces(), surface.receivers, {});
            check_distance(match_samples(few, surface, finest, progress), node, level);
        }
    }
}

LevelSamples sample_level(const LeveledScene& scene, const LeveledNode& node, const CoarserLevel& level,
                          const LevelOptions& options, const Progress& progress) {
    const FinestSurface finest(scene, node, options.threads);
    const PartSurface surface(scene.scene, level.primitives, options.threads);
    LevelSamples samples = match_samples(
        samples_of(surface, vertices_of(scene.scene, node.finest), options.seed), surface, finest, progress);
    check_distance(samples, node, level);
    return samples;
}

double LevelSquares::relative_l2() const {
    return norm > 0 ? std::sqrt(error / norm) : 0;
}

LevelSquares& LevelSquares::operator+=(const LevelSquares& other) {
    error += other.error;
    norm += other.norm;
    return *this;
}

LevelSquares level_error(const LevelSamples& samples, std::span<const float> finest,
                         std::span<const float> level, std::span<const float> column_weights) {
    LevelSquares squares;
    std::vector<double> wanted(column_weights.size()), shown(column_weights.size());
    for (const LevelSample& sample : samples.samples) {
        std::ranges::fill(wanted, 0.0);
        std::ranges::fill(shown, 0.0);
        add_shares(finest, sample.from, sample.from_shares, wanted);
        add_shares(level, sample.at, sample.shares, shown);
        LevelSquares here;
        for (std::size_t c = 0; c < wanted.size(); ++c) {
            const double weight = static_cast<double>(column_weights[c]), missing = wanted[c] - shown[c];
            here.error += weight * missing * missing;
            here.norm += weight * wanted[c] * wanted[c];
        }
        squares.error += static_cast<double>(sample.area) * here.error;
        squares.norm += static_cast<double>(sample.area) * here.norm;
    }
    return squares;
}

LevelSquares level_error(const LevelSamples& samples, const Transfer& finest, const Transfer& level) {
    std::vector<float> weights;
    const TransferLayout& layout = finest.layout;
    for (const TransferTerm& term : layout.terms)
        weights.insert(weights.end(), layout.columns_of(term) * static_cast<std::size_t>(term.channels),
                       static_cast<float>(layout.channels()) / static_cast<float>(term.channels));
    return level_error(samples, finest.vectors, level.vectors, weights);
}

} // namespace prt

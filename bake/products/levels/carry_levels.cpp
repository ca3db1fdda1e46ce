// Fits the transfer of level 0, as samples of a coarser level see it, to the vertices of that level.

#include "bake/products/levels/level_surface.h"
#include "bake/surface_fit/fit_solver.h"
#include "bake/surface_fit/smoothness_weights.h"
#include "runtime/core/support/stopwatch.h"

#include <algorithm>

namespace prt {
namespace {

/// Distance of a level, relative to the diagonal of level 0, above which a notice is added.
constexpr double kFarLevel = 0.05;

class LevelFit {
public:
    LevelFit(const LeveledScene& scene, const Transfer& finest, const LevelOptions& options,
             const Progress& progress)
        : scene_(scene), options_(options), progress_(progress), stride_(finest.dimension()) {
        bake_.transfer = zero_transfer(finest.layout, scene.scene.receivers());
        std::ranges::copy(finest.vectors, bake_.transfer.vectors.begin());
    }

    LevelBake run() {
        const Stopwatch stopwatch;
        for (std::size_t n = 0; n < scene_.nodes.size(); ++n) {
            const LeveledNode& node = scene_.nodes[n];
            const FinestSurface finest(scene_, node, options_.threads);
            for (const CoarserLevel& level : node.coarser)
                carry(node, level, finest);
            progress_.update(static_cast<double>(n + 1) / static_cast<double>(scene_.nodes.size()));
        }
        bake_.seconds = stopwatch.seconds();
        return std::move(bake_);
    }

private:
    void carry(const LeveledNode& node, const CoarserLevel& level, const FinestSurface& finest) {
        const PartSurface surface(scene_.scene, level.primitives, options_.threads);
        const SurfaceSamples points =
            samples_of(surface, vertices_of(scene_.scene, node.finest), options_.seed);
        const LevelSamples samples = match_samples(points, surface, finest, progress_);
        check_distance(samples, node, level);
        const FitEquations equations =
            fit_equations(surface.traced.surfaces(), surface.receivers, points,
                          alike_receivers(surface.traced.surfaces(), surface.receivers));
        begin_at_nearest(surface, finest, equations);
        add_fit(surface, samples, equations);
        note(node, level, samples);
    }

    std::span<float> vector(std::uint32_t receiver) { return bake_.transfer.vector(receiver); }

    /// Initialises vertices with the light of the nearest point of level 0; the fit then corrects it.
    void begin_at_nearest(const PartSurface& surface, const FinestSurface& finest,
                          const FitEquations& equations) {
        const std::vector<NearestPoint> nearest =
            finest.find(surface.points().positions, surface.points().normals, progress_);
        for (std::size_t p = 0; p < nearest.size(); ++p) {
            if (equations.unknown_of[p] == kNoReceiver || nearest[p].triangle == kNoTriangle)
                continue;
            const std::array<std::uint32_t, 3> corners = finest.corners(nearest[p].triangle);
            if (std::ranges::all_of(corners, [&](std::uint32_t corner) {
                    return std::ranges::binary_search(options_.sealed, corner);
                }))
                bake_.sealed.push_back(surface.part.receivers[p]);
            const std::span<float> to = vector(surface.part.receivers[p]);
            for (std::size_t c = 0; c < stride_; ++c) {
                double sum = 0;
                for (std::size_t i = 0; i < 3; ++i)
                    sum += nearest[p].shares[i] * static_cast<double>(vector(corners[i])[c]);
                to[c] = static_cast<float>(sum);
            }
        }
    }

    /// Adds the least-squares solution for the difference at the samples. The samples are dense, and their
    /// light has the noise of level 0: the smoothness weights are those of an initial fit.
    void add_fit(const PartSurface& surface, const LevelSamples& samples, const FitEquations& equations) {
        if (equations.unknowns == 0)
            return;
        std::vector<double> missing(equations.unknowns * stride_);
        for (std::size_t s = 0; s < samples.samples.size(); ++s)
            add_samples<double>(equations, s, missing_at(samples.samples[s]), stride_, missing);
        const std::vector<float> weights(equations.second_differences.size(), kFirstSmoothnessWeight);
        FitSolver(equations, weights).solve(missing, stride_, options_.threads);
        for (std::size_t p = 0; p < surface.part.receivers.size(); ++p) {
            const std::uint32_t u = equations.unknown_of[p];
            for (std::size_t c = 0; u != kNoReceiver && c < stride_; ++c)
                vector(surface.part.receivers[p])[c] += static_cast<float>(missing[u * stride_ + c]);
        }
        progress_.check();
    }

    /// Difference between level 0 and the coarser level at a sample.
    std::vector<double> missing_at(const LevelSample& sample) {
        std::vector<double> sum(stride_);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::span<const float> wanted = vector(sample.from[i]), shown = vector(sample.at[i]);
            const auto share = static_cast<double>(sample.shares[i]),
                       from_share = static_cast<double>(sample.from_shares[i]);
            for (std::size_t c = 0; c < stride_; ++c)
                sum[c] += from_share * static_cast<double>(wanted[c]) - share * static_cast<double>(shown[c]);
        }
        return sum;
    }

    void note(const LeveledNode& node, const CoarserLevel& level, const LevelSamples& samples) {
        LevelOutcome outcome = outcome_of(scene_.scene, node, level, samples);
        outcome.squares = level_error(samples, bake_.transfer, bake_.transfer);
        if (samples.rms_distance > kFarLevel * samples.diagonal)
            bake_.notices.push_back(level.name + " is far from the surface of " + node.name +
                                    ", from which its light is copied; check its distance in the report");
        bake_.levels.push_back(std::move(outcome));
    }

    const LeveledScene& scene_;
    const LevelOptions& options_;
    const Progress& progress_;
    std::size_t stride_;
    LevelBake bake_;
};

} // namespace

LevelBake carry_levels(const LeveledScene& scene, const Transfer& finest, const LevelOptions& options,
                       const Progress& progress) {
    return LevelFit(scene, finest, options, progress).run();
}

} // namespace prt

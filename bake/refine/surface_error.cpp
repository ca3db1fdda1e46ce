// Cross-validates a fit of two folds.

#include "bake/refine/surface_error.h"

#include "bake/surface_fit/fit_solver.h"
#include "bake/surface_fit/smoothness_weights.h"
#include "bake/trace/scrambles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace prt {
namespace {

/// Points of one fold as samples of a fit; `of` has their indices.
struct Fold {
    std::vector<std::size_t> of;
    SurfaceSamples samples; ///< positions and areas only
};

class CrossFit {
public:
    CrossFit(const LitMesh& mesh, const LightPoints& points, int threads)
        : mesh_(mesh), points_(points), threads_(threads), stride_(points.stride()) {
        std::vector<std::array<std::size_t, 2>> counts(mesh.areas.size());
        for (std::size_t p = 0; p < points.size(); ++p)
            ++counts[points.position(p).triangle][points.fold(p)];
        for (std::size_t p = 0; p < points.size(); ++p) {
            const std::size_t fold = points.fold(p);
            const std::uint32_t triangle = points.position(p).triangle;
            folds_[fold].of.push_back(p);
            folds_[fold].samples.positions.push_back(points.position(p));
            folds_[fold].samples.receivers.areas.push_back(
                static_cast<float>(mesh.areas[triangle] / static_cast<double>(counts[triangle][fold])));
        }
        result_.of_triangles.resize(mesh.areas.size());
    }

    SurfaceError judge() {
        std::array<FitEquations, 2> equations;
        const std::vector<std::uint32_t> alike = alike_receivers(mesh_.surfaces, mesh_.receivers);
        for (std::size_t f = 0; f < 2; ++f) {
            equations[f] = fit_equations(mesh_.surfaces, mesh_.receivers, folds_[f].samples, alike);
            for (std::size_t s = 0; s < folds_[f].of.size(); ++s)
                if (points_.sealed(folds_[f].of[s]))
                    equations[f].rows[s].unknowns.fill(kNoReceiver);
        }
        for (std::size_t f = 0; f < 2; ++f)
            compare(fit(equations[f], folds_[f]), equations[1 - f], folds_[1 - f]);
        return std::move(result_);
    }

private:
    /// Fits light from both scrambles, [unknowns][2][order²].
    std::vector<float> fit(const FitEquations& equations, const Fold& fold) const {
        std::vector<float> x(equations.unknowns * stride_);
        for (std::size_t s = 0; s < fold.of.size(); ++s)
            add_samples(equations, s, points_.light(fold.of[s]), stride_, std::span(x));
        const std::vector<float> weights(equations.second_differences.size(), kPlainSmoothnessWeight);
        FitSolver(equations, weights).solve(x, stride_, threads_);
        return x;
    }

    void compare(const std::vector<float>& x, const FitEquations& equations, const Fold& judges) {
        std::vector<float> rest(stride_);
        for (std::size_t s = 0; s < judges.of.size(); ++s) {
            const FitRow& row = equations.rows[s];
            if (std::ranges::count(row.unknowns, kNoReceiver) > 0)
                continue; // sealed
            const std::span<const float> light = points_.light(judges.of[s]);
            for (std::size_t c = 0; c < stride_; ++c) {
                rest[c] = -light[c];
                for (std::size_t i = 0; i < 3; ++i)
                    rest[c] += row.shares[i] * x[row.unknowns[i] * stride_ + c];
            }
            // Each of two folds tests once.
            const double weight = 0.5 * static_cast<double>(row.area);
            result_.of_triangles[judges.samples.positions[s].triangle] += weight * of_both(rest);
            result_.norm += weight * of_both(light);
        }
    }

    static double of_both(std::span<const float> scrambles) {
        const std::size_t half = scrambles.size() / 2;
        return product(scrambles.first(half), scrambles.last(half));
    }

    const LitMesh& mesh_;
    const LightPoints& points_;
    const int threads_;
    const std::size_t stride_;
    std::array<Fold, 2> folds_;
    SurfaceError result_;
};

} // namespace

double SurfaceError::relative_l2() const {
    const double sum = std::accumulate(of_triangles.begin(), of_triangles.end(), 0.0);
    return norm > 0 ? std::sqrt(std::max(0.0, sum) / norm) : 0;
}

SurfaceError surface_error(const LitMesh& mesh, const LightPoints& points, int threads) {
    return CrossFit(mesh, points, threads).judge();
}

} // namespace prt

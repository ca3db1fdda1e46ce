// Multiplies differences from two independent references: the mean of their noise is zero. Intervals are
// computed by resampling points (B. Efron, "Bootstrap Methods: Another Look at the Jackknife", 1979).

#include "bake/studies/error_budget.h"

#include "prt/bake/bake.h"
#include "prt/core/error_measures.h"
#include "prt/core/light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace prt {
namespace {

using Radiance = std::vector<glm::vec3>;

/// Radiance of the picture at a point, from each of two independent references.
std::array<glm::dvec3, 2> picture_at(const SurfaceRadiance& reference, std::size_t p) {
    const glm::dvec3 suns(reference.suns()[p]);
    return {glm::dvec3(reference.truth(0)[p]) + suns, glm::dvec3(reference.truth(1)[p]) + suns};
}

/// [points] 1 / (Y + Y_a)²; empty if nothing is lit.
std::vector<double> contrast_weights(const SurfacePoints& points, const SurfaceRadiance& reference) {
    std::vector<double> weights(points.size());
    for (std::size_t p = 0; p < weights.size(); ++p) {
        const auto [first, second] = picture_at(reference, p);
        weights[p] = luminance(0.5 * (first + second));
    }
    const double adaptation = adaptation_luminance(weights, points.receivers.areas);
    if (!(adaptation > 0))
        return {};
    for (double& weight : weights)
        weight = 1 / std::pow(weight + adaptation, 2);
    return weights;
}

/// Sums over resampled points, for confidence intervals.
class Resampling {
public:
    Resampling(const SurfacePoints& points, const SurfaceRadiance& reference, BudgetMeasure measure) {
        constexpr std::size_t kTimes = 400; // the 2.5th percentile is then the tenth value
        std::mt19937_64 random(1);
        std::vector<double> norm(points.size(), 1.0);
        if (measure == BudgetMeasure::visible) {
            channels_ = kLuminance;
            weights_ = contrast_weights(points, reference);
            norm.assign(points.size(), weights_.empty() ? 0.0 : 1.0);
        } else {
            for (std::size_t p = 0; p < points.size(); ++p) {
                const auto [first, second] = picture_at(reference, p);
                norm[p] = glm::dot(first, second);
            }
        }
        areas_.assign(points.receivers.areas.begin(), points.receivers.areas.end());
        counts_.assign(kTimes, std::vector<float>(points.size(), 0));
        std::uniform_int_distribution<std::size_t> any(0, points.size() - 1);
        for (std::vector<float>& counts : counts_)
            for (std::size_t i = 0; i < counts.size(); ++i)
                ++counts[any(random)];
        norm_ = sum(norm, nullptr);
        for (const std::vector<float>& counts : counts_)
            norms_.push_back(sum(norm, &counts));
    }

    /// Weighted product of two differences of radiance at point `p`.
    double product(std::size_t p, const glm::vec3& a, const glm::vec3& b) const {
        return glm::dot(channels_ * glm::dvec3(a), glm::dvec3(b)) * (weights_.empty() ? 1.0 : weights_[p]);
    }

    /// Estimates the area-weighted mean of `values` [points].
    SquaredError estimate(std::span<const double> values) const {
        SquaredError error;
        if (!(norm_ > 0))
            return error;
        error.value = sum(values, nullptr) / norm_;
        std::vector<double> drawn;
        for (std::size_t t = 0; t < counts_.size(); ++t)
            if (norms_[t] > 0)
                drawn.push_back(sum(values, &counts_[t]) / norms_[t]);
        std::sort(drawn.begin(), drawn.end());
        const auto at = [&](double share) {
            return drawn[static_cast<std::size_t>(share * static_cast<double>(drawn.size() - 1))];
        };
        error.low = at(0.025);
        error.high = at(0.975);
        return error;
    }

private:
    double sum(std::span<const double> values, const std::vector<float>* counts) const {
        double total = 0;
        for (std::size_t p = 0; p < values.size(); ++p)
            total += areas_[p] * values[p] * (counts ? static_cast<double>((*counts)[p]) : 1.0);
        return total;
    }

    glm::dvec3 channels_{1};
    std::vector<double> areas_, weights_; ///< [points]; empty weights mean 1
    std::vector<std::vector<float>> counts_;
    std::vector<double> norms_;
    double norm_ = 0;
};

/// Evaluates `value(p)` at all points.
template <class Value>
std::vector<double> of_points(const SurfacePoints& points, Value&& value) {
    std::vector<double> values(points.size());
    for (std::size_t p = 0; p < values.size(); ++p)
        values[p] = value(p);
    return values;
}

Radiance difference(Radiance of, std::span<const glm::vec3> from) {
    for (std::size_t p = 0; p < of.size(); ++p)
        of[p] -= from[p];
    return of;
}

/// Squared error from the missing radiance according to each of two independent references.
SquaredError error_of(const SurfacePoints& points, const SurfaceRadiance& reference,
                      const std::array<Radiance, 2>& missing) {
    const Resampling resampling(points, reference, BudgetMeasure::relative);
    return resampling.estimate(of_points(
        points, [&](std::size_t p) { return resampling.product(p, missing[0][p], missing[1][p]); }));
}

} // namespace

const char* to_string(ErrorCause cause) {
    static constexpr const char* kNames[] = {"light", "bounces", "vertices", "rays", "bytes"};
    return kNames[static_cast<std::size_t>(cause)];
}

double SquaredError::root() const {
    return std::sqrt(std::max(value, 0.0));
}

double ErrorBudget::sum() const {
    double all = 0;
    for (const SquaredError& cause : causes)
        all += cause.value;
    return all;
}

ErrorBudget error_budget(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const BandTruncation& cut, const InterpolatedRadiance& radiance,
                         BudgetMeasure measure) {
    const Resampling resampling(points, reference, measure);
    const auto estimate = [&](auto&& value) { return resampling.estimate(of_points(points, value)); };
    const auto product = [&](std::size_t p, const glm::vec3& a, const glm::vec3& b) {
        return resampling.product(p, a, b);
    };
    const BandTruncation endless{cut.order, kEndlessBounces, cut.factors};
    const std::span<const glm::vec3> truth[2] = {reference.truth(0), reference.truth(1)};
    const Radiance bands[2] = {reference.under(endless, 0), reference.under(endless, 1)};
    const Radiance wanted[2] = {reference.under(cut, 0), reference.under(cut, 1)};
    const auto &baked = radiance.baked, &repeated = radiance.repeated, &shipped = radiance.shipped;
    ErrorBudget budget;
    budget.of(ErrorCause::light) = estimate(
        [&](std::size_t p) { return product(p, bands[0][p] - truth[0][p], bands[1][p] - truth[1][p]); });
    budget.of(ErrorCause::bounces) = estimate(
        [&](std::size_t p) { return product(p, wanted[0][p] - bands[0][p], wanted[1][p] - bands[1][p]); });
    budget.of(ErrorCause::vertices) = estimate([&](std::size_t p) {
        return 0.5 * (product(p, baked[p] - wanted[0][p], repeated[p] - wanted[1][p]) +
                      product(p, baked[p] - wanted[1][p], repeated[p] - wanted[0][p]));
    });
    // If both bakes have the same number of rays: half of their squared difference. Otherwise the product of
    // the difference and `baked`'s own error: the mean of all terms without noise of `baked` is zero.
    budget.of(ErrorCause::rays) = estimate([&](std::size_t p) {
        const glm::vec3 noise = baked[p] - repeated[p];
        return radiance.alike ? 0.5 * product(p, noise, noise)
                              : product(p, noise, baked[p] - 0.5f * (wanted[0][p] + wanted[1][p]));
    });
    budget.of(ErrorCause::bytes) =
        estimate([&](std::size_t p) { return product(p, shipped[p] - baked[p], shipped[p] - baked[p]); });
    const auto total = of_points(points, [&](std::size_t p) {
        return product(p, shipped[p] - truth[0][p], shipped[p] - truth[1][p]);
    });
    budget.total = resampling.estimate(total);
    budget.together = {budget.total.value - budget.sum(), 0, 0};
    return budget;
}

SquaredError light_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const BandTruncation& cut) {
    const BandTruncation all{cut.order, kEndlessBounces, cut.factors};
    return error_of(points, reference,
                    {difference(reference.under(all, 0), reference.truth(0)),
                     difference(reference.under(all, 1), reference.truth(1))});
}

SquaredError bounces_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                           const BandTruncation& cut) {
    const BandTruncation all{cut.order, kEndlessBounces, cut.factors};
    return error_of(points, reference,
                    {difference(reference.under(all, 0), reference.under(cut, 0)),
                     difference(reference.under(all, 1), reference.under(cut, 1))});
}

SquaredError split_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const QuarterCorners& quarters, const SurfaceRadiance& corners,
                         const BandTruncation& cut) {
    std::array<Radiance, 2> missing;
    for (int half = 0; half < 2; ++half) {
        const Radiance here = reference.under(cut, half), at_corners = corners.under(cut, half);
        for (std::size_t p = 0; p < points.size(); ++p) {
            glm::vec3 sum = -here[p];
            for (std::size_t i = 0; i < 3; ++i)
                sum += quarters.shares[p][i] * at_corners[3 * p + i];
            missing[static_cast<std::size_t>(half)].push_back(sum);
        }
    }
    return error_of(points, reference, missing);
}

ErrorBudget mean_budget(std::span<const ErrorBudget> budgets) {
    ErrorBudget mean;
    const double share = 1 / static_cast<double>(budgets.size());
    const auto add = [share](SquaredError& sum, const SquaredError& one) {
        sum.value += share * one.value;
        sum.low += share * one.low;
        sum.high += share * one.high;
    };
    for (const ErrorBudget& budget : budgets) {
        for (std::size_t c = 0; c < kErrorCauses; ++c)
            add(mean.causes[c], budget.causes[c]);
        add(mean.together, budget.together);
        add(mean.total, budget.total);
    }
    return mean;
}

} // namespace prt

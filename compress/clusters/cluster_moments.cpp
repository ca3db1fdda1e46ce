// Local PCA from incrementally updated moments (Sloan et al. 2003, section 4.2): eigenvectors of each
// cluster's covariance, via a low-rank factor for clusters of few points.

#include "compress/clusters/cluster_moments.h"

#include "compress/tuning/tuning.h"
#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>

namespace prt {
namespace {

/// Points that enter or leave each cluster, ascending, concatenated by cluster.
struct Changes {
    std::vector<std::size_t> first; ///< [clusters + 1]
    std::vector<std::uint32_t> points;

    Changes(std::span<const float> significance, std::span<const std::uint32_t> before,
            std::span<const std::uint32_t> after, std::size_t clusters)
        : first(clusters + 1, 0) {
        const auto visit = [&](auto&& change) {
            for (std::uint32_t p = 0; p < before.size(); ++p)
                if (before[p] != after[p] && significance[p] > 0)
                    for (const std::uint32_t k : {before[p], after[p]})
                        if (k < clusters)
                            change(p, k);
        };
        visit([&](std::uint32_t, std::uint32_t k) { ++first[k + 1]; });
        for (std::size_t k = 0; k < clusters; ++k)
            first[k + 1] += first[k];
        points.resize(first.back());
        std::vector<std::size_t> next(first.begin(), first.end() - 1);
        visit([&](std::uint32_t p, std::uint32_t k) { points[next[k]++] = p; });
    }
    std::span<const std::uint32_t> of(std::size_t k) const {
        return std::span(points).subspan(first[k], first[k + 1] - first[k]);
    }
};

} // namespace

ClusterMoments::ClusterMoments(std::size_t clusters, std::size_t dimension, std::size_t predictors)
    : dimension_(dimension), predictors_(predictors),
      stride_(1 + (dimension + predictors) + (dimension + predictors) * (dimension + predictors + 1) / 2),
      values_(clusters * stride_, 0) {}

void ClusterMoments::add(std::span<const float> point, double significance, std::span<double> moments) {
    const std::size_t dimension = point.size();
    double* sums = &moments[1];
    double* products = sums + dimension;
    moments[0] += significance;
    for (std::size_t i = 0; i < dimension; ++i) {
        const double scaled = significance * static_cast<double>(point[i]);
        sums[i] += scaled;
        for (std::size_t j = 0; j <= i; ++j)
            products[j] += scaled * static_cast<double>(point[j]);
        products += i + 1;
    }
}

void ClusterMoments::build(const PointBlocks& points, std::span<const float> significance,
                           std::span<const std::uint32_t> clusters, int threads) {
    std::fill(values_.begin(), values_.end(), 0);
    const std::vector<std::uint32_t> nowhere(points.count, ~0u);
    update(points, significance, nowhere, clusters, threads);
}

void ClusterMoments::update(const PointBlocks& points, std::span<const float> significance,
                            std::span<const std::uint32_t> before, std::span<const std::uint32_t> after,
                            int threads) {
    const std::size_t count = values_.size() / stride_;
    const Changes changes(significance, before, after, count);
    parallel_for(count, 1, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> point(dimension_ + predictors_);
        for (std::size_t k = begin; k < end; ++k)
            for (const std::uint32_t p : changes.of(k)) {
                points.copy_point(p, point.data());
                add(point, (before[p] == k ? -1 : 1) * static_cast<double>(significance[p]),
                    std::span(values_).subspan(k * stride_, stride_));
            }
    });
}

namespace {

/// Maximum significance of an empty cluster. Rounding errors remain when points come and go. All receivers
/// together have 1, with a rounding error of 2^-53 per addition.
constexpr double kMinSignificance = 1e-14;

struct Covariance {
    Eigen::VectorXd mean;
    Eigen::MatrixXd matrix; ///< lower triangle
};

/// Returns the covariance of coordinates and predictors together.
Covariance joint_covariance(const ClusterMoments::View& moments) {
    const auto d = static_cast<Eigen::Index>(moments.width());
    Covariance result{Eigen::Map<const Eigen::VectorXd>(&moments.values[1], d) / moments.significance(),
                      Eigen::MatrixXd::Zero(d, d)};
    const double* product = moments.values.data() + 1 + d;
    for (Eigen::Index i = 0; i < d; ++i)
        for (Eigen::Index j = 0; j <= i; ++j)
            result.matrix(i, j) = *product++ / moments.significance() - result.mean[i] * result.mean[j];
    return result;
}

/// Regression of the coordinates on the predictors, and the residual.
struct Regression {
    Eigen::MatrixXd slopes;   ///< [predictors][dimension]
    Eigen::MatrixXd residual; ///< covariance, lower triangle
};

/// Computes the least-squares regression with V (V² + ridge²)^-1 instead of V^-1. Clusters whose predictors
/// hardly vary then do not use them; other clusters are almost unchanged.
Regression regression_of(const Covariance& joint, const ClusterMoments::View& moments) {
    const auto d = static_cast<Eigen::Index>(moments.dimension),
               g = static_cast<Eigen::Index>(moments.predictors);
    if (g == 0)
        return {Eigen::MatrixXd(0, d), joint.matrix};
    const Eigen::MatrixXd across = joint.matrix.bottomLeftCorner(g, d),
                          own = joint.matrix.bottomRightCorner(g, g).selfadjointView<Eigen::Lower>();
    const Eigen::MatrixXd ridged =
        own * own + tuning::kPredictorRidge * tuning::kPredictorRidge * Eigen::MatrixXd::Identity(g, g);
    Regression result{ridged.ldlt().solve(own * across), joint.matrix.topLeftCorner(d, d)};
    const Eigen::MatrixXd told = result.slopes.transpose() * (2 * across - own * result.slopes);
    result.residual.triangularView<Eigen::Lower>() -= told;
    return result;
}

/// Returns the variance that float rounding of the points alone can cause along one direction: (2^-24)² of
/// their squared size, with a margin of 4.
double rounding_floor(const Covariance& joint, std::size_t dimension) {
    const auto d = static_cast<Eigen::Index>(dimension);
    return 4 * 0x1p-48 * (joint.mean.head(d).squaredNorm() + joint.matrix.diagonal().head(d).sum());
}

/// Returns L with covariance = L L^T if its rank is at most half of the dimension: pivoted Cholesky until
/// only rounding remains. Clusters of few points have few columns, and their axes cost a hundredth of a full
/// decomposition.
std::optional<Eigen::MatrixXd> low_rank_factor(const Eigen::MatrixXd& lower, double nothing) {
    const Eigen::Index d = lower.rows();
    Eigen::VectorXd left = lower.diagonal();
    Eigen::MatrixXd factor(d, d / 2);
    for (Eigen::Index rank = 0;; ++rank) {
        Eigen::Index pivot = 0;
        const double largest = left.maxCoeff(&pivot);
        if (!(largest > nothing))
            return factor.leftCols(rank).eval();
        if (rank == d / 2)
            return std::nullopt;
        auto column = factor.col(rank);
        for (Eigen::Index i = 0; i < d; ++i)
            column[i] = i < pivot ? lower(pivot, i) : lower(i, pivot);
        column.noalias() -= factor.leftCols(rank) * factor.row(pivot).head(rank).transpose();
        column /= std::sqrt(largest);
        left -= column.cwiseAbs2();
        left[pivot] = 0;
    }
}

/// Principal axes: variances, descending, and on request the directions with variance.
struct Spectrum {
    std::vector<double> variances; ///< [dimension]; 0 if it is only rounding
    Eigen::MatrixXd directions;    ///< columns
};

Spectrum spectrum_of(const Eigen::MatrixXd& covariance, double floor, bool with_directions) {
    const int what = with_directions ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly;
    const auto d = covariance.rows();
    Spectrum spectrum{std::vector<double>(static_cast<std::size_t>(d), 0.0), {}};
    const auto take = [&](const Eigen::VectorXd& ascending) {
        Eigen::Index kept = 0;
        for (Eigen::Index i = ascending.size() - 1; i >= 0 && ascending[i] > floor; --i)
            spectrum.variances[static_cast<std::size_t>(kept++)] = ascending[i];
        return kept;
    };
    if (const auto factor = low_rank_factor(covariance, 0.25 * floor)) {
        if (factor->cols() == 0)
            return spectrum;
        const Eigen::MatrixXd gram = factor->transpose() * *factor;
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram, what);
        const Eigen::Index kept = take(solver.eigenvalues());
        if (with_directions)
            spectrum.directions =
                (*factor * solver.eigenvectors().rowwise().reverse().leftCols(kept)).colwise().normalized();
        return spectrum;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance, what);
    const Eigen::Index kept = take(solver.eigenvalues());
    if (with_directions)
        spectrum.directions = solver.eigenvectors().rowwise().reverse().leftCols(kept);
    return spectrum;
}

} // namespace

ClusterFit fit_cluster(const ClusterMoments::View& moments, const RateBudget& rate_budget) {
    ClusterFit fit;
    fit.mean.assign(moments.dimension, 0.0f);
    fit.center.assign(moments.predictors, 0.0f);
    fit.slopes.assign(moments.predictors * moments.dimension, 0.0f);
    fit.predictor_variances.assign(moments.predictors, 0.0);
    if (!(moments.significance() > kMinSignificance))
        return fit;
    fit.significance = moments.significance();
    if (moments.dimension == 0)
        return fit;
    const Covariance joint = joint_covariance(moments);
    const Regression regression = regression_of(joint, moments);
    const auto to_float = [](double v) { return static_cast<float>(v); };
    const auto d = static_cast<std::ptrdiff_t>(moments.dimension);
    std::transform(joint.mean.begin(), joint.mean.begin() + d, fit.mean.begin(), to_float);
    std::transform(joint.mean.begin() + d, joint.mean.end(), fit.center.begin(), to_float);
    for (std::size_t g = 0; g < moments.predictors; ++g) {
        const auto row = static_cast<Eigen::Index>(g);
        for (std::size_t i = 0; i < moments.dimension; ++i)
            fit.slopes[g * moments.dimension + i] =
                to_float(regression.slopes(row, static_cast<Eigen::Index>(i)));
        fit.predictor_variances[g] = std::max(0.0, joint.matrix(d + row, d + row));
    }
    Spectrum spectrum = spectrum_of(regression.residual, rounding_floor(joint, moments.dimension), true);
    fit.variances = std::move(spectrum.variances);
    fit.plan = plan_components(fit.variances, fit.significance, rate_budget);
    for (std::size_t j = 0; j < fit.plan.bits.size(); ++j) {
        Eigen::VectorXd direction = spectrum.directions.col(static_cast<Eigen::Index>(j));
        Eigen::Index largest = 0; // the sign of an eigenvector is arbitrary; fix it
        direction.cwiseAbs().maxCoeff(&largest);
        if (direction[largest] < 0)
            direction = -direction;
        for (const double v : direction)
            fit.directions.push_back(static_cast<float>(v));
    }
    return fit;
}

double cluster_cost(const ClusterMoments::View& moments, const RateBudget& rate_budget) {
    if (!(moments.significance() > kMinSignificance) || moments.dimension == 0)
        return 0;
    const Covariance joint = joint_covariance(moments);
    const Spectrum spectrum =
        spectrum_of(regression_of(joint, moments).residual, rounding_floor(joint, moments.dimension), false);
    return cost_of(plan_components(spectrum.variances, moments.significance(), rate_budget),
                   moments.significance(), rate_budget);
}

} // namespace prt

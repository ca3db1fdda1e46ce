#include "cluster_moments.h"

#include "prt/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// A point that enters (+1) or leaves (-1) a cluster.
struct Change {
    std::uint32_t point;
    double sign;
};

} // namespace

ClusterMoments::ClusterMoments(std::size_t clusters, std::size_t dimension)
    : dimension_(dimension), stride_(1 + dimension + dimension * (dimension + 1) / 2),
      values_(clusters * stride_, 0) {}

void ClusterMoments::add(const float* point, double weight, std::span<double> moments) {
    const std::size_t dimension =
        static_cast<std::size_t>((std::sqrt(8.0 * static_cast<double>(moments.size()) + 1) - 3) / 2 + 0.5);
    double* sums = &moments[1];
    double* products = sums + dimension;
    moments[0] += weight;
    for (std::size_t i = 0; i < dimension; ++i) {
        const double scaled = weight * static_cast<double>(point[i]);
        sums[i] += scaled;
        for (std::size_t j = 0; j <= i; ++j)
            products[j] += scaled * static_cast<double>(point[j]);
        products += i + 1;
    }
}

void ClusterMoments::build(const PointBlocks& points, std::span<const float> weights,
                           std::span<const std::uint32_t> clusters, int threads) {
    std::fill(values_.begin(), values_.end(), 0);
    const std::vector<std::uint32_t> nowhere(points.count, ~0u);
    update(points, weights, nowhere, clusters, threads);
}

void ClusterMoments::update(const PointBlocks& points, std::span<const float> weights,
                            std::span<const std::uint32_t> before, std::span<const std::uint32_t> after,
                            int threads) {
    const std::size_t count = values_.size() / stride_;
    std::vector<std::vector<Change>> changes(count);
    for (std::uint32_t p = 0; p < points.count; ++p) {
        if (before[p] == after[p] || !(weights[p] > 0))
            continue;
        if (before[p] < count)
            changes[before[p]].push_back({p, -1});
        if (after[p] < count)
            changes[after[p]].push_back({p, 1});
    }
    parallel_for(count, 1, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> point(dimension_);
        for (std::size_t k = begin; k < end; ++k)
            for (const Change& change : changes[k]) {
                points.copy_point(change.point, point.data());
                add(point.data(), change.sign * static_cast<double>(weights[change.point]),
                    std::span(values_).subspan(k * stride_, stride_));
            }
    });
}

ClusterFit fit_cluster(const ClusterMoments::View& moments, const Spending& spending) {
    const auto d = static_cast<Eigen::Index>(moments.dimension);
    ClusterFit fit{std::vector<float>(moments.dimension, 0.0f), {}, {}, {}, 0};
    // Of points that came and went rounding stays behind: nothing below a millionth of a millionth counts.
    if (!(moments.weight() > 1e-14))
        return fit;
    fit.weight = moments.weight();
    const Eigen::Map<const Eigen::VectorXd> sums(&moments.values[1], d);
    const Eigen::VectorXd mean = sums / fit.weight;
    Eigen::MatrixXd covariance(d, d);
    const double* product = moments.values.data() + 1 + d;
    for (Eigen::Index i = 0; i < d; ++i)
        for (Eigen::Index j = 0; j <= i; ++j)
            covariance(i, j) = *product++ / fit.weight - mean[i] * mean[j];
    std::transform(mean.begin(), mean.end(), fit.mean.begin(),
                   [](double v) { return static_cast<float>(v); });
    if (d == 0)
        return fit;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
    std::vector<double> variances(moments.dimension);
    // Variance that float rounding of the points alone can make along one direction: (2^-24)² of their
    // squared size, and a margin of 4.
    const double floor = 4 * 0x1p-48 * (mean.squaredNorm() + covariance.trace());
    for (Eigen::Index i = 0; i < d; ++i) { // eigenvalues ascend
        const double variance = solver.eigenvalues()[d - 1 - i];
        variances[static_cast<std::size_t>(i)] = variance > floor ? variance : 0;
    }
    fit.plan = plan_components(variances, fit.weight, spending);
    fit.variances = std::move(variances);
    for (std::size_t j = 0; j < fit.plan.bits.size(); ++j) {
        Eigen::VectorXd direction = solver.eigenvectors().col(d - 1 - static_cast<Eigen::Index>(j));
        Eigen::Index largest = 0; // the sign of an eigenvector is arbitrary; fix it
        direction.cwiseAbs().maxCoeff(&largest);
        if (direction[largest] < 0)
            direction = -direction;
        for (const double v : direction)
            fit.directions.push_back(static_cast<float>(v));
    }
    return fit;
}

} // namespace prt

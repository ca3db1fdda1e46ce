#include "local_pca.h"

#include "prt/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Points of a cluster by rows, mean subtracted, scaled by the root of their weight.
Eigen::MatrixXd centred_rows(const PointBlocks& points, std::span<const float> weights,
                             std::span<const std::uint32_t> members, Eigen::VectorXd& mean) {
    const auto n = static_cast<Eigen::Index>(members.size()), d = static_cast<Eigen::Index>(points.dimension);
    Eigen::MatrixXd rows(n, d);
    Eigen::VectorXd w(n);
    for (Eigen::Index r = 0; r < n; ++r) {
        const std::size_t p = members[static_cast<std::size_t>(r)];
        w[r] = static_cast<double>(weights[p]);
        for (Eigen::Index i = 0; i < d; ++i)
            rows(r, i) = static_cast<double>(points.coordinate(p, static_cast<std::size_t>(i)));
    }
    mean = rows.transpose() * w / w.sum();
    rows.rowwise() -= mean.transpose();
    rows.array().colwise() *= w.array().sqrt();
    return rows;
}

/// Variance that float rounding of the points alone can make along one direction, relative to the squared
/// size of the points: (2^-24)² per coordinate, and a margin of 4.
double rounding_variance(const Eigen::VectorXd& mean, double total_weight, double total_variance) {
    return 4 * 0x1p-48 * (mean.squaredNorm() * total_weight + total_variance);
}

void fit_cluster(const PointBlocks& points, std::span<const float> weights,
                 std::span<const std::uint32_t> members, int components, std::size_t k,
                 ClusterModels& models) {
    models.components[k] = 0;
    if (members.empty())
        return;
    Eigen::VectorXd mean;
    const Eigen::MatrixXd rows = centred_rows(points, weights, members, mean);
    std::transform(mean.begin(), mean.end(), models.mean(k), [](double v) { return static_cast<float>(v); });

    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rows.cols(), rows.cols());
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
    double total_weight = 0;
    for (const std::uint32_t p : members)
        total_weight += static_cast<double>(weights[p]);
    const double floor = rounding_variance(mean, total_weight, covariance.trace());
    for (int j = 0; j < components; ++j) {
        const Eigen::Index column = rows.cols() - 1 - j; // eigenvalues ascend
        if (solver.eigenvalues()[column] <= floor)
            return;
        Eigen::VectorXd direction = solver.eigenvectors().col(column);
        Eigen::Index largest = 0; // the sign of an eigenvector is arbitrary; fix it
        direction.cwiseAbs().maxCoeff(&largest);
        if (direction[largest] < 0)
            direction = -direction;
        std::transform(direction.begin(), direction.end(), models.direction(k, static_cast<std::size_t>(j)),
                       [](double v) { return static_cast<float>(v); });
        models.components[k] = j + 1;
    }
}

} // namespace

void fit_local_pca(const PointBlocks& points, std::span<const float> weights,
                   std::span<const std::uint32_t> clusters, int components, ClusterModels& models,
                   int threads) {
    std::vector<std::vector<std::uint32_t>> members(models.clusters());
    for (std::uint32_t p = 0; p < points.count; ++p)
        members[clusters[p]].push_back(p);
    parallel_for(models.clusters(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            fit_cluster(points, weights, members[k], components, k, models);
    });
}

double project_point(const PointBlocks& points, std::size_t point, const ClusterModels& models, std::size_t k,
                     std::span<double> weights) {
    const std::size_t dimension = points.dimension;
    thread_local std::vector<double> residual;
    residual.resize(dimension);
    for (std::size_t i = 0; i < dimension; ++i)
        residual[i] =
            static_cast<double>(points.coordinate(point, i)) - static_cast<double>(models.mean(k)[i]);
    for (std::size_t j = 0; j < static_cast<std::size_t>(models.components[k]); ++j) {
        const float* direction = models.direction(k, j);
        double weight = 0;
        for (std::size_t i = 0; i < dimension; ++i)
            weight += static_cast<double>(direction[i]) * residual[i];
        for (std::size_t i = 0; i < dimension; ++i)
            residual[i] -= weight * static_cast<double>(direction[i]);
        weights[j] = weight;
    }
    double squared = 0;
    for (const double r : residual)
        squared += r * r;
    return squared;
}

} // namespace prt

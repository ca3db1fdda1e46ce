#include "prt/jumps.h"

#include "metric/transfer_columns.h"
#include "prt/support/error.h"
#include "prt/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <numeric>

namespace prt {
namespace {

/// A square root of the metric: |factor x|² = x^T C x.
Eigen::MatrixXd factor_of(const LightMetric& metric) {
    const auto n = static_cast<Eigen::Index>(metric.layout.dimension());
    const Eigen::Map<const Eigen::MatrixXd> moments(metric.moments.data(), n, n);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(moments);
    return solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose();
}

Eigen::VectorXd mean_vector(const TransferView& transfer, std::span<const float> areas) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(transfer.dimension()));
    double area = 0;
    constexpr std::size_t kRead = 256;
    for (std::size_t begin = 0; begin < areas.size(); begin += kRead) {
        const std::size_t end = std::min(begin + kRead, areas.size());
        const Eigen::MatrixXf vectors = columns_of(transfer, begin, end);
        for (std::size_t p = begin; p < end; ++p) {
            sum += static_cast<double>(areas[p]) *
                   vectors.col(static_cast<Eigen::Index>(p - begin)).cast<double>();
            area += static_cast<double>(areas[p]);
        }
    }
    return area > 0 ? Eigen::VectorXd(sum / area) : sum;
}

} // namespace

double jump_across_clusters(const TransferView& reference, const TransferView& approximation,
                            std::span<const std::uint16_t> clusters, const ReceiverSurface& surface,
                            const LightMetric& metric, int threads) {
    if (reference.layout() != approximation.layout() || reference.layout() != metric.layout ||
        reference.receivers() != approximation.receivers() || clusters.size() != reference.receivers() ||
        surface.areas.size() != reference.receivers())
        throw Error("the transfers have different orders, parts or numbers of receivers");
    std::vector<Edge> across;
    for (const Edge& edge : surface.edges)
        if (clusters[edge.first] != clusters[edge.second])
            across.push_back(edge);
    const Eigen::MatrixXd factor = factor_of(metric);
    const double mean = (factor * mean_vector(reference, surface.areas)).norm();
    if (across.empty() || !(mean > 0))
        return 0;
    std::vector<double> jumps(across.size());
    parallel_for(across.size(), 256, threads, [&](std::size_t begin, std::size_t end) {
        const auto error = [&](std::size_t p) -> Eigen::VectorXf {
            return columns_of(reference, p, p + 1) - columns_of(approximation, p, p + 1);
        };
        for (std::size_t e = begin; e < end; ++e) {
            const Eigen::VectorXd difference =
                (error(across[e].first) - error(across[e].second)).cast<double>();
            jumps[e] = (factor * difference).norm() / mean;
        }
    });
    const auto area = [&](std::size_t e) {
        return static_cast<double>(surface.areas[across[e].first]) +
               static_cast<double>(surface.areas[across[e].second]);
    };
    std::vector<std::size_t> order(jumps.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return jumps[a] > jumps[b]; });
    double beyond = 0;
    for (const std::size_t e : order)
        beyond += kJumpsBeyond * area(e);
    for (const std::size_t e : order) {
        beyond -= area(e);
        if (beyond < 0)
            return jumps[e];
    }
    return 0; // borders have no area
}

} // namespace prt

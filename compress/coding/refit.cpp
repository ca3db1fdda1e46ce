// Clusters for given codes: the centroid step of vector quantisation (Gersho and Gray 1992), for subspaces by
// the normal equations of docs/math.md, eq. 26.

#include "coding/refit.h"

#include <Eigen/Dense>

namespace prt {
namespace {

/// sum_p a_p z_p z_p^T and sum_p a_p z_p (y_p - what its code stands for)^T, z = (1, w_1, ..., w_m).
struct NormalEquations {
    Eigen::MatrixXd left, right;
};

NormalEquations normal_equations(const PointBlocks& points, std::span<const float> significance,
                                 const Codes& codes, const AffineClusters& clusters, std::size_t k,
                                 std::span<const std::uint32_t> members) {
    const auto d = static_cast<Eigen::Index>(clusters.dimension), m = Eigen::Index{clusters.components[k]};
    NormalEquations equations{Eigen::MatrixXd::Zero(m + 1, m + 1), Eigen::MatrixXd::Zero(m + 1, d)};
    std::vector<float> point(clusters.dimension);
    Eigen::VectorXd z(m + 1), residual(d);
    z[0] = 1;
    for (const std::uint32_t p : members) {
        if (!(significance[p] > 0))
            continue;
        points.copy_point(p, point.data());
        const std::span<const float> w = codes.of(p);
        for (Eigen::Index i = 0; i < d; ++i)
            residual[i] = static_cast<double>(point[static_cast<std::size_t>(i)]) -
                          static_cast<double>(clusters.mean(k)[i]);
        for (Eigen::Index j = 0; j < m; ++j) {
            const auto at = static_cast<std::size_t>(j);
            z[1 + j] = static_cast<double>(w[at]);
            residual -= z[1 + j] * Eigen::Map<const Eigen::VectorXf>(clusters.row(k, at), d).cast<double>();
        }
        equations.left.selfadjointView<Eigen::Lower>().rankUpdate(z, static_cast<double>(significance[p]));
        equations.right += static_cast<double>(significance[p]) * z * residual.transpose();
    }
    return equations;
}

} // namespace

void refit(const PointBlocks& points, std::span<const float> significance, const Codes& codes,
           AffineClusters& clusters, int threads) {
    if (points.dimension == 0)
        return;
    const ClusterLists members = members_of(codes.clusters, clusters.clusters());
    parallel_for(clusters.clusters(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            auto [left, right] = normal_equations(points, significance, codes, clusters, k, members[k]);
            if (!(left(0, 0) > 0))
                continue;
            // What the points do not determine stays as it is.
            left.diagonal().array() += 1e-9 * left(0, 0);
            const Eigen::MatrixXd change = left.selfadjointView<Eigen::Lower>().ldlt().solve(right);
            for (Eigen::Index i = 0; i < change.cols(); ++i) {
                clusters.mean(k)[i] += static_cast<float>(change(0, i));
                for (Eigen::Index j = 1; j < change.rows(); ++j)
                    clusters.row(k, static_cast<std::size_t>(j - 1))[i] += static_cast<float>(change(j, i));
            }
        }
    });
}

} // namespace prt

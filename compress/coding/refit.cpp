// Fits clusters to given codes: the centroid step of vector quantisation (Gersho and Gray 1992), for
// subspaces by the normal equations of docs/math.md, eq. 26.

#include "compress/coding/refit.h"

#include "compress/tuning/tuning.h"

#include <Eigen/Dense>

namespace prt {
namespace {

/// Computes sum_p a_p z_p z_p^T, a_p with the scales of each group, and sum_p a_p z_p (y_p - decoded
/// value)^T, z = (1, predictors - center, w_1, ..., w_m).
struct NormalEquations {
    std::vector<Eigen::MatrixXd> left; ///< [groups]
    Eigen::MatrixXd right;
};

NormalEquations normal_equations(const PointBlocks& points, std::span<const float> significance,
                                 const Codes& codes, const QuantisedClusters& clusters, std::size_t k,
                                 std::span<const std::uint32_t> members) {
    const auto d = static_cast<Eigen::Index>(clusters.dimension), m = Eigen::Index{clusters.components[k]},
               known = 1 + static_cast<Eigen::Index>(clusters.predictors), n = known + m;
    const PointScales& scales = points.scales;
    NormalEquations equations{{std::max<std::size_t>(scales.groups, 1), Eigen::MatrixXd::Zero(n, n)},
                              Eigen::MatrixXd::Zero(n, d)};
    std::vector<float> point(points.width()), w(clusters.max_components);
    Eigen::VectorXd z(n), residual(d);
    z[0] = 1;
    for (const std::uint32_t p : members) {
        if (!(significance[p] > 0))
            continue;
        points.copy_point(p, point.data());
        codes.read(clusters, p, w.data());
        subtract_known(clusters, k, point.data());
        residual = Eigen::Map<const Eigen::VectorXf>(point.data(), d).cast<double>();
        for (std::size_t g = 0; g < clusters.predictors; ++g)
            z[1 + static_cast<Eigen::Index>(g)] =
                static_cast<double>(point[clusters.dimension + g] - clusters.center(k)[g]);
        for (Eigen::Index j = 0; j < m; ++j) {
            const auto at = static_cast<std::size_t>(j);
            z[known + j] = static_cast<double>(w[at]);
            residual -=
                z[known + j] * Eigen::Map<const Eigen::VectorXf>(clusters.row(k, at), d).cast<double>();
        }
        const auto squared = [&](std::size_t group) {
            const double scale = scales.all_alike() ? 1 : static_cast<double>(scales.of(p)[group]);
            return static_cast<double>(significance[p]) * scale * scale;
        };
        for (std::size_t g = 0; g < equations.left.size(); ++g)
            equations.left[g].selfadjointView<Eigen::Lower>().rankUpdate(z, squared(g));
        for (Eigen::Index i = 0; i < d; ++i)
            residual[i] *= squared(scales.all_alike() ? 0 : scales.group_of[static_cast<std::size_t>(i)]);
        equations.right += z * residual.transpose();
    }
    return equations;
}

} // namespace

void refit(const PointBlocks& points, std::span<const float> significance, const Codes& codes,
           QuantisedClusters& clusters, int threads) {
    if (points.dimension == 0)
        return;
    const ClusterLists members = members_of(codes.clusters, clusters.clusters());
    parallel_for(clusters.clusters(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            auto [left, right] = normal_equations(points, significance, codes, clusters, k, members[k]);
            if (!(left[0](0, 0) > 0))
                continue;
            Eigen::MatrixXd change(right.rows(), right.cols());
            for (std::size_t g = 0; g < left.size(); ++g) {
                // The ridge keeps values that the points hardly determine: a single slope of 30 would make
                // the rounding of all rows coarse.
                left[g].diagonal().array() += tuning::kRefitRidge * left[g](0, 0);
                const auto solver = left[g].selfadjointView<Eigen::Lower>().ldlt();
                for (Eigen::Index i = 0; i < change.cols(); ++i)
                    if (points.scales.all_alike() || points.scales.group_of[static_cast<std::size_t>(i)] == g)
                        change.col(i) = solver.solve(right.col(i));
            }
            const auto add = [&](Eigen::Index from, float* to) {
                for (Eigen::Index i = 0; i < change.cols(); ++i)
                    to[i] += static_cast<float>(change(from, i));
            };
            Eigen::Index from = 0;
            add(from++, clusters.mean(k));
            for (std::size_t g = 0; g < clusters.predictors; ++g)
                add(from++, clusters.slope(k, g));
            for (std::size_t j = 0; j < clusters.components_of(k); ++j)
                add(from++, clusters.row(k, j));
        }
    });
}

} // namespace prt

// Measures contrast jumps between clusters (docs/math.md, eq. 33c).

#include "compress/metric/jumps.h"

#include "compress/metric/color_blocks.h"
#include "compress/metric/rotated_lighting.h"
#include "compress/metric/transfer_columns.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/light.h"
#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <numbers>

namespace prt {
namespace {

/// Returns a square root of the metric: |factor x|² = x^T C x.
Eigen::MatrixXd factor_of(const LightMetric& metric) {
    const auto n = static_cast<Eigen::Index>(metric.layout.dimension());
    const Eigen::Map<const Eigen::MatrixXd> moments(metric.moments.data(), n, n);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(moments);
    return solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose();
}

/// Returns the edges whose ends are in different clusters.
std::vector<Edge> edges_across(std::span<const Edge> edges, std::span<const std::uint16_t> clusters) {
    std::vector<Edge> across;
    for (const Edge& edge : edges)
        if (clusters[edge.first] != clusters[edge.second])
            across.push_back(edge);
    return across;
}

/// Returns the luminance rows of each of `skies` at each rotation, one row each.
Eigen::MatrixXd rows_of_skies(std::span<const Lighting> skies, const TransferLayout& layout) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(kRotationsOfJumps * static_cast<Eigen::Index>(skies.size()),
                                                 static_cast<Eigen::Index>(layout.dimension()));
    Eigen::Index row = 0;
    for (const Lighting& sky : skies)
        for (int r = 0; r < kRotationsOfJumps; ++r, ++row) {
            const double angle = 2 * std::numbers::pi * r / kRotationsOfJumps;
            const Lighting rotated = rotated_about_y(sky, layout.order, angle);
            const std::vector<glm::vec3> columns = light_columns(layout, rotated);
            for (glm::length_t c = 0; c < 3; ++c) {
                const std::vector<std::size_t> numbers = numbers_of_color(layout, c);
                for (std::size_t k = 0; k < columns.size(); ++k)
                    rows(row, static_cast<Eigen::Index>(numbers[k])) +=
                        kLuminance[c] * static_cast<double>(columns[k][c]);
            }
        }
    return rows;
}

/// Throws `Error` unless `surface` has an area for each receiver.
void check_areas(const TransferView& reference, const ReceiverSurface& surface) {
    if (surface.areas.size() != reference.receivers())
        throw Error("the numbers of areas and of receivers of the transfer differ");
}

constexpr std::size_t kJumpsGrain = 256; ///< receivers or edges per task

} // namespace

/// Lights in groups with an equal number of rows. The luminance of a vector under a group is the norm of the
/// group's rows times the vector.
struct ClusterJumps::Lights {
    Eigen::MatrixXf rows;
    Eigen::Index rows_of_group = 1;
    std::vector<double> adaptations; ///< [groups] Y_a

    Eigen::Index groups() const { return rows.rows() / rows_of_group; }
    auto rows_of(Eigen::Index group) const { return rows.middleRows(group * rows_of_group, rows_of_group); }

    void adapt_to(const TransferView& reference, std::span<const float> areas, int threads) {
        for (Eigen::Index g = 0; g < groups(); ++g) {
            std::vector<double> luminances(reference.receivers());
            parallel_for(luminances.size(), kJumpsGrain, threads, [&](std::size_t begin, std::size_t end) {
                const Eigen::RowVectorXf seen =
                    (rows_of(g) * columns_of(reference, begin, end)).colwise().norm();
                std::ranges::copy(seen, &luminances[begin]);
            });
            adaptations.push_back(adaptation_luminance(luminances, areas));
        }
    }
    /// Returns the contrast errors of a receiver with vector `reference`, [rows of group].
    Eigen::VectorXf contrast(Eigen::Index group, const Eigen::VectorXf& reference,
                             const Eigen::VectorXf& approximation) const {
        const float seen = (rows_of(group) * reference).norm() +
                           static_cast<float>(adaptations[static_cast<std::size_t>(group)]);
        return rows_of(group) * (approximation - reference) / seen;
    }
};

ClusterJumps::ClusterJumps(const TransferView& reference, const ReceiverSurface& surface,
                           const LightMetric& metric, int threads)
    : reference_(reference), surface_(surface), threads_(threads) {
    check_areas(reference, surface);
    if (reference.layout() != metric.layout)
        throw Error("the metric and the transfer have different orders or terms");
    const Eigen::MatrixXd factor = factor_of(metric);
    Lights lights{factor.cast<float>(), factor.rows(), {}};
    lights.adapt_to(reference, surface.areas, threads);
    lights_ = std::make_unique<const Lights>(std::move(lights));
}

ClusterJumps::ClusterJumps(const TransferView& reference, const ReceiverSurface& surface,
                           std::span<const Lighting> skies, int threads)
    : reference_(reference), surface_(surface), threads_(threads) {
    check_areas(reference, surface);
    Lights lights{rows_of_skies(skies, reference.layout()).cast<float>(), 1, {}};
    lights.adapt_to(reference, surface.areas, threads);
    lights_ = std::make_unique<const Lights>(std::move(lights));
}

ClusterJumps::~ClusterJumps() = default;

double ClusterJumps::percentile_99(const TransferView& approximation,
                                   std::span<const std::uint16_t> clusters) const {
    const TransferView& reference = reference_;
    if (reference.layout() != approximation.layout() || reference.receivers() != approximation.receivers() ||
        clusters.size() != reference.receivers() || surface_.areas.size() != reference.receivers())
        throw Error("the transfers have different orders, terms or numbers of receivers");
    const std::vector<Edge> across = edges_across(surface_.edges, clusters);
    const auto groups = static_cast<std::size_t>(lights_->groups());
    std::vector<std::vector<double>> jumps(groups, std::vector<double>(across.size()));
    parallel_for(across.size(), kJumpsGrain, threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) {
            const std::size_t p = across[e].first, q = across[e].second;
            const Eigen::VectorXf of_p = columns_of(reference, p, p + 1),
                                  of_q = columns_of(reference, q, q + 1),
                                  near_p = columns_of(approximation, p, p + 1),
                                  near_q = columns_of(approximation, q, q + 1);
            for (std::size_t g = 0; g < groups; ++g)
                if (const auto group = static_cast<Eigen::Index>(g); lights_->adaptations[g] > 0)
                    jumps[g][e] = static_cast<double>(
                        (lights_->contrast(group, of_p, near_p) - lights_->contrast(group, of_q, near_q))
                            .norm());
        }
    });
    double worst = 0;
    for (const std::vector<double>& of_group : jumps)
        worst = std::max(worst, edge_jumps(across, of_group, surface_.areas).percentile_99);
    return worst;
}

} // namespace prt

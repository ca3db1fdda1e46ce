#include "prt/jumps.h"

#include "metric/color_blocks.h"
#include "metric/transfer_columns.h"
#include "prt/support/error.h"
#include "prt/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <numbers>
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

/// Edges whose ends are in different clusters.
std::vector<Edge> edges_across(std::span<const Edge> edges, std::span<const std::uint16_t> clusters) {
    std::vector<Edge> across;
    for (const Edge& edge : edges)
        if (clusters[edge.first] != clusters[edge.second])
            across.push_back(edge);
    return across;
}

/// The errors of the second ends of `edges` less those of the first, side by side: [dimension][edges].
Eigen::MatrixXf differences(const TransferView& reference, const TransferView& approximation,
                            std::span<const Edge> edges) {
    Eigen::MatrixXf result(static_cast<Eigen::Index>(reference.dimension()),
                           static_cast<Eigen::Index>(edges.size()));
    const auto error = [&](std::size_t p) -> Eigen::VectorXf {
        return columns_of(reference, p, p + 1) - columns_of(approximation, p, p + 1);
    };
    for (std::size_t e = 0; e < edges.size(); ++e)
        result.col(static_cast<Eigen::Index>(e)) = error(edges[e].second) - error(edges[e].first);
    return result;
}

/// The value that `kJumpsBeyond` of the area beside `edges` exceeds.
float percentile(std::span<const float> jumps, std::span<const Edge> edges, std::span<const float> areas) {
    const auto area = [&](std::size_t e) {
        return static_cast<double>(areas[edges[e].first]) + static_cast<double>(areas[edges[e].second]);
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

/// Lights of an error: groups of the same number of rows, which errors and the mean are multiplied with. The
/// jump of a group is the length of what its rows give of an error over that of the mean.
struct Views {
    Eigen::MatrixXd rows;
    Eigen::Index rows_of_group = 1;
    Eigen::Index groups() const { return rows.rows() / rows_of_group; }
};

/// The three colors of each of `skies` at each rotation.
Views views_of_skies(std::span<const Lighting> skies, const TransferLayout& layout) {
    Views views{Eigen::MatrixXd::Zero(3 * kRotationsOfJumps * static_cast<Eigen::Index>(skies.size()),
                                      static_cast<Eigen::Index>(layout.dimension())),
                3};
    Eigen::Index row = 0;
    for (const Lighting& sky : skies)
        for (int r = 0; r < kRotationsOfJumps; ++r) {
            const double angle = 2 * std::numbers::pi * r / kRotationsOfJumps;
            Lighting turned{rotated_about_y(truncated(sky.sky, layout.order), angle), {}, sky.lamps};
            if (sky.suns)
                turned.suns = rotated_about_y(truncated(*sky.suns, layout.order), angle);
            const std::vector<glm::vec3> columns = light_columns(layout, turned);
            for (int c = 0; c < 3; ++c, ++row) {
                const std::vector<std::size_t> numbers = numbers_of_color(layout, c);
                for (std::size_t k = 0; k < columns.size(); ++k)
                    views.rows(row, static_cast<Eigen::Index>(numbers[k])) =
                        static_cast<double>(columns[k][c]);
            }
        }
    return views;
}

/// The greatest percentile of all groups that see the mean.
double worst_jump(const TransferView& reference, const TransferView& approximation,
                  std::span<const std::uint16_t> clusters, const ReceiverSurface& surface, const Views& views,
                  int threads) {
    const std::vector<Edge> across = edges_across(surface.edges, clusters);
    const Eigen::VectorXd seen = views.rows * mean_vector(reference, surface.areas);
    const auto edges = static_cast<Eigen::Index>(across.size());
    const Eigen::MatrixXf rows = views.rows.cast<float>();
    Eigen::MatrixXf jumps(edges, views.groups());
    parallel_for(across.size(), 256, threads, [&](std::size_t begin, std::size_t end) {
        const Eigen::MatrixXf errors =
            rows * differences(reference, approximation, std::span(across).subspan(begin, end - begin));
        for (Eigen::Index g = 0; g < views.groups(); ++g)
            jumps.block(static_cast<Eigen::Index>(begin), g, errors.cols(), 1) =
                errors.middleRows(g * views.rows_of_group, views.rows_of_group).colwise().norm().transpose();
    });
    std::vector<double> worst(static_cast<std::size_t>(views.groups()), 0);
    parallel_for(worst.size(), 1, threads, [&](std::size_t g, std::size_t) {
        const auto group = static_cast<Eigen::Index>(g);
        const double mean = seen.segment(group * views.rows_of_group, views.rows_of_group).norm();
        if (mean > 0)
            worst[g] = static_cast<double>(
                           percentile({jumps.col(group).data(), across.size()}, across, surface.areas)) /
                       mean;
    });
    return worst.empty() ? 0 : std::ranges::max(worst);
}

void check(const TransferView& reference, const TransferView& approximation,
           std::span<const std::uint16_t> clusters, const ReceiverSurface& surface) {
    if (reference.layout() != approximation.layout() || reference.receivers() != approximation.receivers() ||
        clusters.size() != reference.receivers() || surface.areas.size() != reference.receivers())
        throw Error("the transfers have different orders, parts or numbers of receivers");
}

} // namespace

double jump_across_clusters(const TransferView& reference, const TransferView& approximation,
                            std::span<const std::uint16_t> clusters, const ReceiverSurface& surface,
                            const LightMetric& metric, int threads) {
    check(reference, approximation, clusters, surface);
    if (reference.layout() != metric.layout)
        throw Error("the metric has another order or other parts than the transfer");
    const Eigen::MatrixXd factor = factor_of(metric);
    return worst_jump(reference, approximation, clusters, surface, {factor, factor.rows()}, threads);
}

double worst_jump_across_clusters(const TransferView& reference, const TransferView& approximation,
                                  std::span<const std::uint16_t> clusters, const ReceiverSurface& surface,
                                  std::span<const Lighting> skies, int threads) {
    check(reference, approximation, clusters, surface);
    return worst_jump(reference, approximation, clusters, surface, views_of_skies(skies, reference.layout()),
                      threads);
}

} // namespace prt

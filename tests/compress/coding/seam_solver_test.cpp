// The seam solver on meshes so small that eq. 28 (docs/math.md) can be lowered by other means: its sum is
// written here once more, in double, from its definition.

#include "compress/coding/seams.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prt {
namespace {

constexpr std::size_t kDimension = 4, kClusters = 4;

/// Receivers in a chain, with an edge from every fourth to the fourth next; clusters alternate along the
/// chain.
struct SmallMesh {
    PointBlocks points;
    std::vector<float> significance;
    std::vector<Edge> edges;
    std::vector<int> degrees;
    QuantisedClusters clusters;
    Codes codes;

    /// Creates clusters with a distance of `separate` between means; rows of one cluster are orthogonal, and
    /// oblique to those of the others.
    SmallMesh(std::size_t count, std::size_t components, float separate, const WeightGrid& grid)
        : clusters{AffineClusters(kClusters, kDimension, components), {}} {
        std::mt19937 random(3);
        std::uniform_real_distribution<float> unit(-1, 1);
        clusters.grids.assign(kClusters * components, grid);
        for (std::size_t k = 0; k < kClusters; ++k) {
            clusters.components[k] = static_cast<int>(components);
            clusters.mean(k)[kDimension - 1] = separate * static_cast<float>(k);
            const float lean = 0.6f * unit(random);
            const float rows[2][2] = {{std::cos(lean), std::sin(lean)}, {-std::sin(lean), std::cos(lean)}};
            for (std::size_t j = 0; j < components; ++j)
                std::copy_n(rows[j], 2, clusters.row(k, j) + j);
        }
        points.count = count;
        points.dimension = kDimension;
        points.values.resize(points.blocks() * kDimension * kLanes);
        for (std::size_t p = 0; p < count; ++p) {
            codes.clusters.push_back(static_cast<std::uint32_t>(p % kClusters));
            significance.push_back((1.5f + unit(random)) / static_cast<float>(count));
            for (std::size_t i = 0; i < kDimension; ++i)
                points.values[(p / kLanes * kDimension + i) * kLanes + p % kLanes] =
                    clusters.mean(codes.clusters[p])[i] + unit(random);
            if (p + 1 < count)
                edges.push_back({static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(p + 1)});
            if (p % 4 == 0 && p + 4 < count)
                edges.push_back({static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(p + 4)});
        }
        degrees.resize(count);
        for (const Edge& e : edges) {
            ++degrees[e.first];
            ++degrees[e.second];
        }
        encode_in_place(points, clusters, codes, 1);
    }

    Eigen::VectorXd row(std::size_t k, std::size_t j) const {
        return Eigen::Map<const Eigen::VectorXf>(clusters.row(k, j), kDimension).cast<double>();
    }
    /// Code minus point.
    Eigen::VectorXd error(const Codes& of, std::size_t p) const {
        const std::uint32_t k = of.clusters[p];
        Eigen::VectorXd e = Eigen::Map<const Eigen::VectorXf>(clusters.mean(k), kDimension).cast<double>();
        for (std::size_t i = 0; i < kDimension; ++i)
            e[static_cast<Eigen::Index>(i)] -= static_cast<double>(points.coordinate(p, i));
        const std::vector<float> w = weights(of, p);
        for (std::size_t j = 0; j < w.size(); ++j)
            e += static_cast<double>(w[j]) * row(k, j);
        return e;
    }
    std::vector<float> weights(const Codes& of, std::size_t p) const {
        std::vector<float> w(clusters.components_of(of.clusters[p]));
        of.read(clusters, p, w.data());
        return w;
    }
    double share(const Edge& edge) const {
        return static_cast<double>(significance[edge.first]) / degrees[edge.first] +
               static_cast<double>(significance[edge.second]) / degrees[edge.second];
    }
    double mean_error(const Codes& of) const {
        double sum = 0;
        for (std::size_t p = 0; p < points.count; ++p)
            sum += static_cast<double>(significance[p]) * error(of, p).squaredNorm();
        return sum;
    }
    /// The sum of eq. 28.
    double energy(const Codes& of, double seam_weight) const {
        double sum = mean_error(of);
        for (const Edge& e : edges)
            sum += seam_weight * share(e) * (error(of, e.first) - error(of, e.second)).squaredNorm();
        return sum;
    }
};

/// Returns the minimum of eq. 28 over the weights, with the receivers' clusters fixed: a dense least-squares
/// problem.
double min_energy(const SmallMesh& mesh, double seam_weight) {
    const std::size_t components = mesh.clusters.max_components;
    const auto unknowns = static_cast<Eigen::Index>(mesh.points.count * components),
               rows = static_cast<Eigen::Index>(kDimension * (mesh.points.count + mesh.edges.size()));
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, unknowns);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(rows);
    Codes none = mesh.codes;
    none.weights = CodeWeights(mesh.points.count, mesh.clusters); // all zero: they may be any
    Eigen::Index at = 0;
    const auto add = [&](std::size_t p, double factor) {
        right.segment(at, kDimension) -= factor * mesh.error(none, p);
        for (std::size_t j = 0; j < components; ++j)
            matrix.col(static_cast<Eigen::Index>(p * components + j)).segment(at, kDimension) +=
                factor * mesh.row(none.clusters[p], j);
    };
    for (std::size_t p = 0; p < mesh.points.count; ++p, at += kDimension)
        add(p, std::sqrt(static_cast<double>(mesh.significance[p])));
    for (const Edge& e : mesh.edges) {
        add(e.first, std::sqrt(seam_weight * mesh.share(e)));
        add(e.second, -std::sqrt(seam_weight * mesh.share(e)));
        at += kDimension;
    }
    const Eigen::VectorXd weights = matrix.colPivHouseholderQr().solve(right);
    return (matrix * weights - right).squaredNorm();
}

TEST(SeamSolver, ContinuousWeightsReachTheMinimum) {
    // Means are so far from each other that all receivers keep their cluster. Sweeps over single receivers
    // would converge slowly, because the seam weight couples neighbours.
    for (const std::size_t components : {1u, 2u}) {
        SmallMesh mesh(12, components, 100, WeightGrid::any());
        constexpr double kMultiplier = 50;
        const double start = mesh.energy(mesh.codes, kMultiplier), least = min_energy(mesh, kMultiplier);
        ASSERT_LT(least, 0.9 * start);
        const std::vector<std::uint32_t> before = mesh.codes.clusters;
        smooth_seams(mesh.points, mesh.significance, mesh.edges, {}, mesh.clusters,
                     {.seam_weight = kMultiplier}, mesh.codes);
        EXPECT_EQ(mesh.codes.clusters, before);
        // Points of 300 are floats, and the solver ends where the squared residual fell to 1e-6.
        EXPECT_NEAR(mesh.energy(mesh.codes, kMultiplier), least, 1e-4 * (start - least));
    }
}

TEST(SeamSolver, LeavesNoCheaperSingleCode) {
    // Clusters lie near each other, and weights have eight values, all of which are tried.
    SmallMesh mesh(60, 1, 0.5f, WeightGrid::of_bits(3));
    constexpr double kMultiplier = 2;
    const double start = mesh.energy(mesh.codes, kMultiplier);
    smooth_seams(mesh.points, mesh.significance, mesh.edges, {}, mesh.clusters, {.seam_weight = kMultiplier},
                 mesh.codes);
    const double reached = mesh.energy(mesh.codes, kMultiplier);
    EXPECT_LT(reached, 0.95 * start);
    for (const Edge& edge : mesh.edges)
        for (const auto& [p, q] : {std::pair(edge.first, edge.second), {edge.second, edge.first}})
            for (const std::uint32_t k : {mesh.codes.clusters[p], mesh.codes.clusters[q]})
                for (int i = 0; i < 8; ++i) {
                    Codes other = mesh.codes;
                    other.clusters[p] = k;
                    const float weight = static_cast<float>(2 * i - 7) / 7;
                    other.weights.write(mesh.clusters, k, p, &weight);
                    EXPECT_GE(mesh.energy(other, kMultiplier), (1 - 1e-6) * reached) << p << " " << k;
                }
    for (std::size_t p = 0; p < mesh.points.count; ++p)
        EXPECT_NEAR(static_cast<double>(mesh.codes.errors[p]), mesh.error(mesh.codes, p).squaredNorm(), 1e-5);
}

TEST(SeamSolver, StretchesReachTheJointSolution) {
    // Continuous weights: solving all receivers together reaches the minimum; a stretch with fixed neighbours
    // misses it because of the coupling to them.
    constexpr double kMultiplier = 2;
    SmallMesh together(400, 2, 100, WeightGrid::any());
    const double start = together.energy(together.codes, kMultiplier);
    SmallMesh stretches = together;
    smooth_seams(together.points, together.significance, together.edges, {}, together.clusters,
                 {.seam_weight = kMultiplier}, together.codes);
    smooth_seams(stretches.points, stretches.significance, stretches.edges, {}, stretches.clusters,
                 {.seam_weight = kMultiplier, .solved_together = 40}, stretches.codes);
    const double least = together.energy(together.codes, kMultiplier),
                 reached = stretches.energy(stretches.codes, kMultiplier);
    EXPECT_LT(least, 0.95 * start);
    EXPECT_LT(reached - least, 0.02 * (start - least));
}

TEST(SeamSolver, KeepsClustersWithoutCheaperAlternatives) {
    // All clusters are equal and have only a mean.
    SmallMesh mesh(12, 0, 0, WeightGrid::any());
    const std::vector<std::uint32_t> before = mesh.codes.clusters;
    smooth_seams(mesh.points, mesh.significance, mesh.edges, {}, mesh.clusters, {.seam_weight = 1},
                 mesh.codes);
    EXPECT_EQ(mesh.codes.clusters, before);
}

} // namespace
} // namespace prt

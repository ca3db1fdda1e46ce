// Tests the moving basis.

#include "moving_basis_baseline.h"
#include "moving_basis_candidates.h"
#include "moving_basis_code.h"
#include "prt/core/error_measures.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prt {
namespace {

using Index = Eigen::Index;

/// Spread over a box of 2 x 1 x 1.
std::vector<glm::vec3> sample_positions(std::size_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<glm::vec3> positions = {{0, 0, 0}, {2, 1, 1}};
    while (positions.size() < count)
        positions.push_back({2 * uniform(random), uniform(random), uniform(random)});
    return positions;
}

GridPoints points_of(std::span<const glm::vec3> positions, Index dimension) {
    const auto count = static_cast<Index>(positions.size());
    return {RowMatrix::Zero(count, dimension),
            std::vector<float>(positions.size(), 1 / static_cast<float>(positions.size())), positions, 1};
}

/// Returns points with the values of a basis that rotates by about twenty degrees from node to node.
GridPoints points_on(const SparseGrid& grid, std::span<const glm::vec3> positions, std::size_t components) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    const auto count = static_cast<Index>(components), nodes = static_cast<Index>(grid.nodes.size());
    GridPoints points = points_of(positions, 6);
    MovingBasis basis{components, RowMatrix((1 + count) * nodes, 6),
                      RowMatrix(static_cast<Index>(positions.size()), count)};
    for (Index row = 0; row < basis.rows.rows(); ++row)
        for (Index i = 0; i < 6; ++i)
            basis.rows(row, i) = (row % (1 + count) == i ? 1.0f : 0.0f) + 0.15f * normal(random);
    for (float& weight : basis.weights.reshaped())
        weight = normal(random);
    points.values = values_of(points, grid, basis);
    return points;
}

double root_error(const GridPoints& points, const MovingBasisFit& fit) {
    return std::sqrt(squared_error(points, values_of(points, fit.grid, fit.basis)));
}

constexpr MovingBasisSchedule exactly(int rounds) {
    return {.multipliers = {}, .weight_multiplier = 0, .rounds = rounds};
}

TEST(SparseGrid, InterpolatesLinearFunctionsWithTheRequiredNodes) {
    const std::vector<glm::vec3> positions = sample_positions(300);
    const SparseGrid grid = sparse_grid(positions, 0.3);
    EXPECT_EQ(grid.nodes_of_box, 8u * 5 * 5);
    for (const SparseGrid::Cell& cell : grid.cells)
        for (std::size_t i = cell.begin; i < cell.end; ++i) {
            glm::vec3 position(0);
            for (std::size_t corner = 0; corner < kCorners; ++corner)
                position += grid.share[i][corner] * 0.3f * glm::vec3(grid.nodes[cell.nodes[corner]]);
            EXPECT_LT(glm::distance(position, positions[grid.receivers[i]]), 1e-5f);
        }
    // Points on the edge of a box lie between two nodes each: one cell of 2, and one beyond an empty one.
    const std::vector<glm::vec3> edge = {{0, 0, 0}, {0.5f, 0, 0}, {2.5f, 0, 0}};
    EXPECT_EQ(sparse_grid(edge, 1).nodes.size(), 4u);
    EXPECT_EQ(sparse_grid(std::vector<glm::vec3>(5, glm::vec3(1, 2, 3)), 1).nodes.size(), 1u);
}

TEST(SparseGrid, FinerGridsInheritValues) {
    const std::vector<glm::vec3> positions = sample_positions(400);
    const SparseGrid coarse = sparse_grid(positions, 1), fine = sparse_grid(positions, 0.5);
    const GridPoints points = points_on(coarse, positions, 0);
    MovingBasisFit fit = fit_moving_basis(points, 1, 0, exactly(20));
    ASSERT_LT(root_error(points, fit), 1e-4);
    const RowMatrix on_fine = values_of(points, fine, on_finer_grid(fit.basis, coarse, fine));
    EXPECT_LT(std::sqrt(squared_error(points, on_fine)), 1e-4);
}

TEST(MovingBasis, FindsAMovingBasis) {
    const std::vector<glm::vec3> positions = sample_positions(600);
    const SparseGrid grid = sparse_grid(positions, 1);
    for (const std::size_t components : {0u, 1u, 2u}) {
        const GridPoints points = points_on(grid, positions, components);
        const MovingBasisFit fit = fit_moving_basis(points, 1, components, exactly(600));
        EXPECT_LT(root_error(points, fit), 5e-4) << components; // for values of about 1, in float
        if (components > 0) {
            const MovingBasisFit less = fit_moving_basis(points, 1, components - 1, exactly(50));
            EXPECT_GT(root_error(points, less), 0.1) << components;
        }
    }
}

TEST(MovingBasis, LinearTransferNeedsNoWeights) {
    const std::vector<glm::vec3> positions = sample_positions(200);
    GridPoints points = points_of(positions, 3);
    for (Index p = 0; p < points.values.rows(); ++p) {
        const glm::vec3& x = positions[static_cast<std::size_t>(p)];
        points.values.row(p) << 1 + x.x - 2 * x.y, 3 * x.z, x.x + x.y + x.z;
    }
    for (const std::size_t components : {0u, 1u})
        for (const double size : {2.0, 0.7})
            EXPECT_LT(root_error(points, fit_moving_basis(points, size, components, exactly(200))), 6e-4);
}

TEST(MovingBasis, NormalisingChangesNoValue) {
    const std::vector<glm::vec3> positions = sample_positions(500);
    const SparseGrid grid = sparse_grid(positions, 1);
    const GridPoints points = points_on(grid, positions, 3);
    MovingBasisFit fit = fit_moving_basis(points, 1, 3, {.multipliers = {0, 0.1f}, .rounds = 5});
    fit.basis.weights.col(1) = 3 * fit.basis.weights.col(0) - fit.basis.weights.col(1);
    fit.basis.weights.array() += 0.5f;
    const RowMatrix before = values_of(points, fit.grid, fit.basis);
    normalise(points, fit.grid, fit.basis);
    EXPECT_LT((values_of(points, fit.grid, fit.basis) - before).cwiseAbs().maxCoeff(), 1e-4f);
    EXPECT_LT(fit.basis.weights.colwise().mean().cwiseAbs().maxCoeff(), 1e-4f);
    const Eigen::MatrixXf covariance = fit.basis.weights.transpose() * fit.basis.weights / 500;
    EXPECT_LT((covariance - Eigen::MatrixXf::Identity(3, 3)).cwiseAbs().maxCoeff(), 1e-3f);
    const std::vector<double> energies = energies_of(points, fit.grid, fit.basis);
    EXPECT_TRUE(std::is_sorted(energies.rbegin(), energies.rend()));
}

TEST(MovingBasis, CountsBitsOfRowsByTheirReach) {
    // At either end of an edge 1/2 and -1/2, plus or minus 1/10: a squared error of 1/100 remains. The step
    // that adds a fifth of it is sqrt(12/500) = 0.155, three of which are 1/2: -3 .. 3 have 3 bits, at 2
    // nodes.
    std::vector<glm::vec3> positions;
    for (int i = 0; i < 40; ++i)
        positions.push_back({i % 2, 0, 0});
    GridPoints points = points_of(positions, 1);
    for (Index p = 0; p < 40; ++p)
        points.values(p, 0) = (p % 2 == 0 ? 0.5f : -0.5f) + (p / 2 % 2 == 0 ? 0.1f : -0.1f);
    const MovingBasisFit fit = fit_moving_basis(points, 1, 0, exactly(10));
    const MovingBasisCode code = code_moving_basis(points, fit, 32, 0.2);
    EXPECT_EQ(code.components, 0u);
    EXPECT_NEAR(code.error, 0.01 + std::pow(0.5 - 3 * std::sqrt(12.0 / 500), 2), 1e-5);
    // two positions of four bytes, and twice this number of entries
    EXPECT_EQ(code.table_bytes, 16 + 2 * 3 / 8.0 + 3);
}

TEST(MovingBasis, KeepsToItsBytesAndNodes) {
    const std::vector<glm::vec3> positions = sample_positions(800);
    Transfer transfer = zero_transfer(2, 1, 800);
    for (std::size_t p = 0; p < 800; ++p) {
        const glm::vec3 x = positions[p];
        const float sign = p % 2 == 0 ? 1.0f : -1.0f;
        transfer.vector(p)[0] = 1 + 0.1f * x.x;
        transfer.vector(p)[1] = sign * std::sin(x.x);
        transfer.vector(p)[2] = sign * std::cos(x.x);
        transfer.vector(p)[3] = 0.05f * std::sin(9 * x.y);
    }
    const std::vector<float> areas(800, 1.0f);
    const ReceiverSurface surface{.areas = areas, .positions = positions};
    const LightMetric metric = plain_metric(transfer.layout);
    for (const double bytes : {300.0, 600.0}) {
        const auto found = moving_basis(
            transfer, surface, {.components = 2, .weight_bits = 16, .table_bytes = bytes, .metric = metric});
        ASSERT_TRUE(found);
        EXPECT_LE(found->result.table_bytes, bytes);
        EXPECT_GT(found->nodes, 8u);
        EXPECT_EQ(found->result.payload_bytes, 4); // two bytes in a word
        EXPECT_EQ(found->result.mean_components, 8 * (1 + 2));
    }
    EXPECT_FALSE(moving_basis(transfer, surface, {.table_bytes = 20, .metric = metric}));
    const auto one =
        moving_basis(transfer, surface, {.components = 1, .weight_bits = 40, .nodes = 50, .metric = metric});
    ASSERT_TRUE(one);
    EXPECT_LE(one->nodes, 50u);
    EXPECT_EQ(one->result.payload_bytes, 8);
    // One rotating direction is one component of a moving basis, and two components of a fixed one.
    const auto still = classic_cpca(transfer, areas, {.clusters = 1, .components = 1});
    EXPECT_LT(relative_l2(transfer, one->result.decoded, areas), 0.05);
    EXPECT_GT(relative_l2(transfer, still.decoded, areas), 0.2);
    const auto blend =
        moving_basis(transfer, surface, {.components = 0, .weight_bits = 0, .nodes = 50, .metric = metric});
    EXPECT_EQ(blend->result.payload_bytes, 0);
    EXPECT_EQ(blend->result.mean_components, 8);
}

TEST(MovingBasis, DoesNotDependOnThreads) {
    const std::vector<glm::vec3> positions = sample_positions(3000);
    Transfer transfer = zero_transfer(3, 1, 3000);
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    for (float& v : transfer.vectors)
        v = normal(random);
    const std::vector<float> areas(3000, 1.0f);
    const ReceiverSurface surface{.areas = areas, .positions = positions};
    MovingBasisOptions options{.components = 3, .nodes = 60, .metric = plain_metric(transfer.layout)};
    options.threads = 1;
    const auto one = moving_basis(transfer, surface, options);
    options.threads = 3;
    const auto three = moving_basis(transfer, surface, options);
    EXPECT_EQ(one->result.decoded.vectors, three->result.decoded.vectors);
    EXPECT_EQ(one->result.table_bytes, three->result.table_bytes);
}

TEST(MovingBasis, AcceptsDegenerateTransfer) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    Transfer any = zero_transfer(2, 1, 50), constant = any;
    for (float& v : any.vectors)
        v = normal(random);
    for (std::size_t p = 0; p < 50; ++p)
        constant.vector(p)[0] = 0.75f;
    Transfer single = zero_transfer(2, 1, 1);
    single.vector(0)[1] = 0.5f;
    const std::vector<glm::vec3> spread = sample_positions(50), same(50, glm::vec3(3));
    const auto error_of = [](const Transfer& transfer, std::span<const glm::vec3> positions, int bits) {
        const std::vector<float> areas(transfer.receivers(), 1.0f);
        const auto found = moving_basis(
            transfer, {.areas = areas, .positions = positions},
            {.components = 4, .weight_bits = bits, .nodes = 100, .metric = plain_metric(transfer.layout)});
        return found ? relative_l2(transfer, found->result.decoded, areas) : 1;
    };
    EXPECT_EQ(error_of(zero_transfer(2, 1, 50), spread, 32), 0);
    EXPECT_EQ(error_of(constant, spread, 32), 0);
    EXPECT_EQ(error_of(constant, same, 32), 0);
    EXPECT_EQ(error_of(single, std::span(same).first(1), 32), 0);
    // One node is plain PCA: with all four components only rounding is lost.
    EXPECT_LT(error_of(any, same, 64), 1e-3);
}

TEST(MovingBasis, IsInTheTablesOfTheSweep) {
    const std::vector<glm::vec3> positions = sample_positions(500);
    Transfer transfer = zero_transfer(2, 1, 500);
    for (std::size_t p = 0; p < 500; ++p) {
        transfer.vector(p)[0] = 1 + 0.4f * std::sin(4 * positions[p].x);
        transfer.vector(p)[1] = std::cos(3 * positions[p].y);
        transfer.vector(p)[2] = 0.3f * std::sin(9 * positions[p].z);
    }
    const std::vector<float> areas(500, 1.0f);
    std::size_t by_bytes = 0, by_components = 0;
    for (const SweepCandidate& candidate :
         moving_basis_candidates(transfer, {.areas = areas, .positions = positions}, 0)) {
        EXPECT_EQ(candidate.method, kMovingBasis);
        const auto found = candidate.run({});
        ASSERT_TRUE(found);
        if (candidate.tables == SweepTables::by_bytes) {
            ++by_bytes;
            EXPECT_LE(found->coded.payload_bytes + found->coded.table_bytes / 500, kSweepBytes[3]);
        } else {
            if (by_components++ == 0) { // means alone
                EXPECT_EQ(found->coded.payload_bytes, 0);
                EXPECT_EQ(found->coded.mean_components, 8);
            }
            EXPECT_LE(std::stoi(found->setting), kSweepClusters);
        }
    }
    EXPECT_EQ(by_bytes, 8u);
    EXPECT_EQ(by_components, 4u);
    // Lightmaps have no positions.
    EXPECT_TRUE(moving_basis_candidates(transfer, {.areas = areas}, 0).empty());
}

} // namespace
} // namespace prt

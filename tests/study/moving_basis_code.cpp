// Few bits for a moving basis.

#include "moving_basis_code.h"

#include "compress/clusters/component_plan.h"
#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prt {
namespace {

using Index = Eigen::Index;

/// 2^bits weights evenly over [-reach, reach] (docs/math.md, eq. 25).
struct WeightSteps {
    float reach = 0;
    float most = 1; ///< 2^bits - 1

    float nearest(float weight) const {
        if (!(reach > 0))
            return 0;
        const float q = std::round((std::clamp(weight / reach, -1.0f, 1.0f) + 1) * most / 2);
        return reach * (2 * q - most) / most;
    }
};

/// Returns the steps for the range with the smallest rounding error: a few receivers may have far larger
/// weights than all others.
WeightSteps steps_for(const GridPoints& points, const RowMatrix& weights, Index component, int bits) {
    WeightSteps steps{weights.col(component).cwiseAbs().maxCoeff(), static_cast<float>((1 << bits) - 1)};
    const float deviation =
        std::sqrt(weights.col(component).squaredNorm() / static_cast<float>(weights.rows()));
    WeightSteps best = steps;
    double least = std::numeric_limits<double>::infinity();
    for (; steps.reach >= deviation && steps.reach > 0; steps.reach *= tuning::kReachFactor) {
        double error = 0;
        for (Index p = 0; p < weights.rows(); ++p) {
            const float d = weights(p, component) - steps.nearest(weights(p, component));
            error += static_cast<double>(points.significance[static_cast<std::size_t>(p)] * d * d);
        }
        if (error < least) {
            least = error;
            best = steps;
        }
    }
    return best;
}

/// Rounds each weight given the residual of the previous ones (Babai 1986), then one by one given all others.
void round_weights(const WeightEquations& equations, std::span<const WeightSteps> steps,
                   Eigen::Ref<Eigen::RowVectorXf> weights) {
    const Eigen::MatrixXf& gram = equations.gram;
    Eigen::VectorXf right = equations.right;
    for (Index l = 0; l < gram.rows(); ++l) {
        const Index left = gram.rows() - l;
        const Eigen::VectorXf best = gram.bottomRightCorner(left, left).ldlt().solve(right.tail(left));
        weights[l] = steps[static_cast<std::size_t>(l)].nearest(best[0]);
        right -= gram.col(l) * weights[l];
    }
    for (int sweep = 0; sweep < tuning::kWeightSweeps; ++sweep)
        for (Index l = 0; l < gram.rows(); ++l)
            weights[l] = steps[static_cast<std::size_t>(l)].nearest(
                weights[l] + (equations.right[l] - gram.row(l).dot(weights)) / gram(l, l));
}

/// Solves for weights and rounds them to the best steps.
void code_weights(const GridPoints& points, MovingBasisFit& fit, std::span<const std::uint8_t> bits,
                  float multiplier) {
    solve_weights(points, fit.grid, fit.basis, multiplier);
    std::vector<WeightSteps> steps;
    for (std::size_t l = 0; l < bits.size(); ++l)
        steps.push_back(steps_for(points, fit.basis.weights, static_cast<Index>(l), bits[l]));
    const std::vector<SparseGrid::Cell>& cells = fit.grid.cells;
    parallel_for(cells.size(), 8, points.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c)
            for (std::size_t i = cells[c].begin; i < cells[c].end; ++i)
                round_weights(weight_equations(points, fit.grid, fit.basis, cells[c], i, multiplier), steps,
                              fit.basis.weights.row(fit.grid.receivers[i]));
    });
}

/// Returns the step of rows that adds the squared `error` to values: each value is a sum over corners with
/// independent rounding, and over components with weights of variance 1.
float step_of_rows(const GridPoints& points, const MovingBasisFit& fit, double error) {
    double squares = 0;
    for (std::size_t i = 0; i < fit.grid.share.size(); ++i)
        for (const float share : fit.grid.share[i])
            squares += static_cast<double>(points.significance[fit.grid.receivers[i]] * share * share);
    const auto numbers = static_cast<double>(fit.basis.rows.cols() * fit.basis.rows_per_node());
    return static_cast<float>(std::sqrt(12 * error / (squares * numbers)));
}

/// Rounds rows to multiples of `step` and returns their bytes: each number of each row has, at all nodes, the
/// bits that its range requires, plus three bytes for its minimum and its number of bits.
double round_rows(MovingBasis& basis, float step) {
    const Index kinds = basis.rows_per_node(), nodes = basis.rows.rows() / kinds;
    double bytes = 0;
    for (Index kind = 0; kind < kinds; ++kind)
        for (Index axis = 0; axis < basis.rows.cols(); ++axis) {
            float least = 0, most = 0;
            for (Index n = 0; n < nodes; ++n) {
                float& value = basis.rows(n * kinds + kind, axis);
                const float q = std::round(value / step);
                least = n == 0 ? q : std::min(least, q);
                most = n == 0 ? q : std::max(most, q);
                value = q * step;
            }
            const double values = static_cast<double>(most - least) + 1;
            bytes += std::ceil(std::log2(values)) * static_cast<double>(nodes) / 8 + 3;
        }
    return bytes;
}

/// Returns the bytes of node positions: two bytes for every node of the box, or a hash table with entries of
/// four bytes, half of them used.
double bytes_of_positions(const SparseGrid& grid) {
    return static_cast<double>(std::min(2 * grid.nodes_of_box, 8 * grid.nodes.size()));
}

} // namespace

MovingBasisCode code_moving_basis(const GridPoints& points, MovingBasisFit fit, int bits, double row_share) {
    ComponentPlan plan;
    if (fit.basis.components > 0) // without bits the plan would have weights as floats
        plan = plan_components(energies_of(points, fit.grid, fit.basis), 1,
                               {.component_limit = static_cast<int>(fit.basis.components), .bits = bits});
    const RowMultipliers multipliers{tuning::kSmoothness, tuning::kRowRidge};
    const auto multiplier = static_cast<float>(tuning::kWeightMultiplier *
                                               squared_error(points, values_of(points, fit.grid, fit.basis)));
    fit.basis = truncated(fit.basis, plan.bits.size());
    for (int round = 0; round < tuning::kCodeRounds; ++round) {
        code_weights(points, fit, plan.bits, multiplier);
        improve_rows(points, fit.grid, fit.basis, multipliers, tuning::kRowStepsOfCode);
    }
    MovingBasisCode code;
    code.components = plan.bits.size();
    code.error = squared_error(points, values_of(points, fit.grid, fit.basis));
    code.table_bytes = bytes_of_positions(fit.grid) + static_cast<double>(plan.bits.size() * sizeof(float));
    const float step = step_of_rows(points, fit, row_share * code.error);
    if (step > 0) {
        code.table_bytes += round_rows(fit.basis, step);
        code_weights(points, fit, plan.bits, multiplier);
    } else // the code must be lossless
        code.table_bytes += static_cast<double>(fit.basis.rows.size()) * sizeof(float);
    code.values = values_of(points, fit.grid, fit.basis);
    code.error = squared_error(points, code.values);
    return code;
}

} // namespace prt

// Finds the weakest filter for which lighting is nowhere negative: a quadratic program in the factors of the
// bands, with one constraint per direction and channel (docs/math.md, eq. 16 to 19).

#include "prt/core/dering.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/light/finite_light.h"
#include "runtime/core/light/radiance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace prt {
namespace {

/// Tolerance of minima as a fraction of the mean. Smaller negative values are removed by reducing the
/// contrast, which is cheaper.
constexpr double kSlack = 0.01;
/// The first grid proves little, but contains the relevant directions.
constexpr double kCoarseShare = 0.05;

/// The radiance of one channel in one direction is row[0] + sum of factors[l] row[l].
using Row = std::array<double, kMaxOrder>;

double value_of(const Row& row, const BandFactors& factors, int order) {
    double value = row[0];
    for (std::size_t l = 1; l < static_cast<std::size_t>(order); ++l)
        value += factors[l] * row[l];
    return value;
}

/// Minimises sum_l weights[l] (1 - factors[l])² subject to non-negative values of all rows, by the active-set
/// method of Lawson and Hanson (Solving Least Squares Problems, 1974, ch. 23) on the dual problem. Factors
/// are 1 + sum_k multiplier_k row_k / weights over the active rows k, whose value is 0 and multiplier_k > 0.
class LeastChange {
public:
    LeastChange(int order, const Row& weights) : order_(order), weights_(weights) {
        for (std::size_t l = 1; l < static_cast<std::size_t>(order); ++l) {
            Row at_most_one{1}, at_least_zero{0};
            at_most_one[l] = -1;
            at_least_zero[l] = 1;
            rows_.push_back(at_most_one);
            rows_.push_back(at_least_zero);
        }
    }

    /// Adds a constraint. Rows that are non-negative for all factors in 0..1 are ignored.
    void add(const Row& row) {
        double least = row[0];
        for (std::size_t l = 1; l < static_cast<std::size_t>(order_); ++l)
            least += std::min(row[l], 0.0);
        if (least < 0)
            rows_.push_back(row);
    }

    BandFactors solve() {
        BandFactors factors = ones();
        multipliers_.clear();
        active_.clear();
        constexpr int kMaxSteps = 500; // about 20 are typical
        for (int step = 0; step < kMaxSteps; ++step) {
            const std::size_t worst = lowest_row(factors);
            if (value_of(rows_[worst], factors, order_) >= -0.1 * kSlack ||
                std::find(active_.begin(), active_.end(), worst) != active_.end())
                break;
            active_.push_back(worst);
            multipliers_.push_back(0);
            settle();
            factors = ones();
            for (std::size_t k = 0; k < active_.size(); ++k)
                for (std::size_t l = 1; l < static_cast<std::size_t>(order_); ++l)
                    factors[l] += multipliers_[k] * rows_[active_[k]][l] / weights_[l];
        }
        for (double& factor : factors)
            factor = std::clamp(factor, 0.0, 1.0); // rounding
        return factors;
    }

private:
    static BandFactors ones() {
        BandFactors factors;
        factors.fill(1);
        return factors;
    }

    std::size_t lowest_row(const BandFactors& factors) const {
        std::size_t lowest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < rows_.size(); ++k)
            if (const double value = value_of(rows_[k], factors, order_); value < least) {
                least = value;
                lowest = k;
            }
        return lowest;
    }

    /// Moves to the multipliers for which all active rows are 0. A row whose multiplier becomes negative on
    /// the way is deactivated.
    void settle() {
        while (!active_.empty()) {
            const std::vector<double> goal = multipliers_for_zero();
            double share = 1;
            std::size_t leaving = goal.size();
            for (std::size_t k = 0; k < goal.size(); ++k)
                if (goal[k] <= 0)
                    if (const double reach = multipliers_[k] / (multipliers_[k] - goal[k]);
                        !(reach >= share)) {
                        share = reach;
                        leaving = k;
                    }
            if (leaving == goal.size()) {
                multipliers_ = goal;
                return;
            }
            for (std::size_t k = 0; k < goal.size(); ++k)
                multipliers_[k] += share * (goal[k] - multipliers_[k]);
            active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(leaving));
            multipliers_.erase(multipliers_.begin() + static_cast<std::ptrdiff_t>(leaving));
        }
    }

    /// Solves sum_j (row_k · row_j / weights) m_j = -value_k(1) by Cholesky decomposition. More rows than
    /// bands are linearly dependent: a small diagonal term lets the least important row leave.
    std::vector<double> multipliers_for_zero() const {
        const std::size_t n = active_.size();
        std::vector<double> matrix(n * n), x(n);
        for (std::size_t i = 0; i < n; ++i) {
            const Row& row = rows_[active_[i]];
            x[i] = -value_of(row, ones(), order_);
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = 0;
                for (std::size_t l = 1; l < static_cast<std::size_t>(order_); ++l)
                    sum += row[l] * rows_[active_[j]][l] / weights_[l];
                matrix[i * n + j] = i == j ? sum * (1 + 1e-10) : sum;
            }
        }
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = matrix[i * n + j];
                for (std::size_t k = 0; k < j; ++k)
                    sum -= matrix[i * n + k] * matrix[j * n + k];
                matrix[i * n + j] =
                    i == j ? std::sqrt(std::max(sum, 1e-12 * matrix[i * n + i])) : sum / matrix[j * n + j];
            }
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k < i; ++k)
                x[i] -= matrix[i * n + k] * x[k];
            x[i] /= matrix[i * n + i];
        }
        for (std::size_t i = n; i-- > 0;) {
            for (std::size_t k = i + 1; k < n; ++k)
                x[i] -= matrix[k * n + i] * x[k];
            x[i] /= matrix[i * n + i];
        }
        return x;
    }

    int order_;
    Row weights_;
    std::vector<Row> rows_;
    std::vector<std::size_t> active_;
    std::vector<double> multipliers_;
};

/// Returns the weight of each band: the effect of its change on the exit radiance of receivers. This is its
/// power times 1/l², the power of transfer (docs/math.md, eq. 17).
Row weights_of(const Light& light) {
    Row weights{};
    double total = 0;
    for (int l = 1; l < light.order; ++l) {
        for (int m = -l; m <= l; ++m) {
            const glm::dvec3 c(light.coefficients[static_cast<std::size_t>(sh_index(l, m))]);
            weights[static_cast<std::size_t>(l)] += (c.r * c.r + c.g * c.g + c.b * c.b) / (l * l);
        }
        total += weights[static_cast<std::size_t>(l)];
    }
    for (double& weight : weights) // the factor of an empty band is arbitrary
        weight = std::max(weight, 1e-12 * total);
    return weights;
}

/// Adds one row for every point and channel with a positive mean, relative to the mean.
void add_rows(const Light& light, std::span<const LowPoint> points, LeastChange& problem) {
    std::array<float, kMaxOrder * kMaxOrder> basis{};
    const glm::dvec3 means(usable_mean(light, 0), usable_mean(light, 1), usable_mean(light, 2));
    for (const LowPoint& point : points) {
        evaluate_sh(light.order, point.direction, std::span<float>(basis));
        for (int c = 0; c < 3; ++c) {
            const double mean = means[c];
            if (!(mean > 0))
                continue;
            Row row{1};
            for (int l = 1; l < light.order; ++l)
                for (auto i = static_cast<std::size_t>(l * l);
                     i < static_cast<std::size_t>((l + 1) * (l + 1)); ++i)
                    row[static_cast<std::size_t>(l)] +=
                        static_cast<double>(basis[i] * light.coefficients[i][c]) / mean;
            problem.add(row);
        }
    }
}

/// Throws `Error` for coefficients above 1e37. Basis values are below 10, so that their products fit a float.
void check_brightness(const Light& light) {
    constexpr float kBrightest = 1e37f;
    check_finite(light.coefficients);
    for (const glm::vec3& v : light.coefficients)
        if (std::max({std::abs(v.r), std::abs(v.g), std::abs(v.b)}) > kBrightest)
            throw Error("lighting with coefficients greater than 1e37 cannot be deringed");
}

} // namespace

BandFactors dering_factors(const Light& light) {
    check_brightness(light);
    BandFactors factors;
    factors.fill(1);
    LeastChange problem(light.order, weights_of(light));
    int rows = rows_for(light.order, kCoarseShare);
    double lower = 0;
    constexpr int kMaxRounds = 10; // three are typical
    for (int round = 0; round < kMaxRounds; ++round) {
        const GridRadiance grid = radiance_on_grid(with_band_factors(light, factors), rows);
        lower = grid.least - share_between(light.order, rows) * grid.range();
        if (lower >= 0)
            break;
        if (grid.least < -kSlack) {
            add_rows(light, grid.points, problem);
            factors = problem.solve();
            continue;
        }
        const int enough = rows_for(light.order, std::max(grid.least, kSlack) / grid.range());
        if (enough <= rows)
            break;
        rows = enough;
    }
    // Remove the remaining negative values by less contrast: 1 + s (v - 1) is 0 at the minimum of v.
    for (std::size_t l = 1; l < factors.size(); ++l)
        factors[l] /= 1 - std::min(lower, 0.0);
    return factors;
}

Light deringed(const Light& light) {
    return with_band_factors(light, dering_factors(light));
}

Light with_band_factors(const Light& light, const BandFactors& factors) {
    Light result = light;
    for (int l = 0; l < light.order; ++l)
        for (int m = -l; m <= l; ++m)
            result.coefficients[static_cast<std::size_t>(sh_index(l, m))] *=
                static_cast<float>(factors[static_cast<std::size_t>(l)]);
    return finite_light(std::move(result));
}

} // namespace prt

// Computes errors under any lighting from second moments of transfer, and the worst error over all rotations
// about +Y.

#include "compress/metric/error_moments.h"

#include "compress/metric/color_blocks.h"
#include "compress/metric/rotated_lighting.h"
#include "compress/metric/transfer_columns.h"
#include "compress/tuning/tuning.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace prt {
namespace {

using Matrix = Eigen::MatrixXd;
using std::numbers::pi;

/// Number of receiver ranges that are summed in parallel, independent of the number of threads, and block
/// size within a range.
constexpr std::size_t kStretches = 8, kBlock = 512;

double ratio(double error, double reference) {
    if (reference > 0)
        return std::sqrt(std::max(error, 0.0) / reference);
    return error > 0 ? std::numeric_limits<double>::infinity() : 0;
}

std::vector<double> whole(const Matrix& lower) {
    const Matrix all = lower.selfadjointView<Eigen::Lower>();
    return {all.data(), all.data() + all.size()};
}

/// Returns sum_p a_p v_p v_p^T of the vectors that `block(begin, end)` returns as columns, vectors or their
/// differences.
template <class Block>
std::vector<double> sums_of_squares(std::size_t dimension, std::span<const float> areas, int threads,
                                    Block&& block) {
    const auto n = static_cast<Eigen::Index>(dimension);
    std::array<Matrix, kStretches> stretches;
    const auto first_of = [&](std::size_t stretch) { return areas.size() * stretch / kStretches; };
    parallel_for(kStretches, 1, threads, [&](std::size_t stretch, std::size_t) {
        Matrix sums = Matrix::Zero(n, n);
        const std::size_t last = first_of(stretch + 1);
        for (std::size_t begin = first_of(stretch); begin < last; begin += kBlock) {
            const std::size_t end = std::min(begin + kBlock, last);
            const Eigen::Map<const Eigen::VectorXf> shares(areas.data() + begin,
                                                           static_cast<Eigen::Index>(end - begin));
            const Matrix columns = block(begin, end) * shares.cast<double>().cwiseSqrt().asDiagonal();
            sums.selfadjointView<Eigen::Lower>().rankUpdate(columns);
        }
        stretches[stretch] = std::move(sums);
    });
    for (std::size_t stretch = 1; stretch < kStretches; ++stretch)
        stretches[0] += stretches[stretch];
    return whole(stretches[0]);
}

/// Squared error and square of exit radiance, summed over receivers and colors.
struct Squares {
    double error = 0, reference = 0;
};

Squares squares_under(const ErrorMoments& moments, const LightingView& lighting) {
    const auto n = static_cast<Eigen::Index>(moments.layout.dimension());
    const Eigen::Map<const Matrix> errors(moments.errors.data(), n, n),
        references(moments.references.data(), n, n);
    const std::vector<glm::vec3> columns = light_columns(moments.layout, lighting);
    Squares sums;
    for (int c = 0; c < 3; ++c) {
        const std::vector<std::size_t> numbers = numbers_of_color(moments.layout, c);
        Eigen::VectorXd light = Eigen::VectorXd::Zero(n);
        for (std::size_t k = 0; k < columns.size(); ++k)
            light[static_cast<Eigen::Index>(numbers[k])] = static_cast<double>(columns[k][c]);
        sums.error += light.dot(errors * light);
        sums.reference += light.dot(references * light);
    }
    return sums;
}

/// Returns the mean of a^T R b over all 3D rotations of two lights, without band 0. Rotations mix the
/// coefficients of a band evenly (Schur's lemma): sum_l (a_l . b_l) tr(R_l) / (2l + 1).
double rotated_mean(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Matrix& squares) {
    double sum = 0;
    for (Eigen::Index l = 1; l * l < a.size(); ++l) {
        const Eigen::Index count = 2 * l + 1;
        sum += a.segment(l * l, count).dot(b.segment(l * l, count)) *
               squares.diagonal().segment(l * l, count).sum() / static_cast<double>(count);
    }
    return sum;
}

/// Returns the square of exit radiance, summed over receivers and colors, averaged over all 3D rotations of
/// distant light; lamps are constant.
double mean_square_over_rotations(const ErrorMoments& moments, const Lighting& lighting) {
    const TransferLayout& layout = moments.layout;
    const auto n = static_cast<Eigen::Index>(layout.dimension());
    const Eigen::Map<const Matrix> references(moments.references.data(), n, n);
    const std::vector<glm::vec3> columns = light_columns(layout, lighting);
    const std::size_t terms = layout.distant_terms().size();
    const Eigen::Index size = coefficient_count(layout.order);
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
        const std::vector<std::size_t> numbers = numbers_of_color(layout, c);
        Eigen::VectorXd constant = Eigen::VectorXd::Zero(n); // band 0, and lamps
        std::vector<Eigen::VectorXd> lights(terms, Eigen::VectorXd::Zero(size));
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const auto value = static_cast<double>(columns[k][c]);
            const std::size_t term = k / static_cast<std::size_t>(size),
                              i = k % static_cast<std::size_t>(size);
            if (term < terms)
                lights[term][static_cast<Eigen::Index>(i)] = value;
            if (term >= terms || i == 0)
                constant[static_cast<Eigen::Index>(numbers[k])] = value;
        }
        sum += constant.dot(references * constant);
        const auto first = [&](std::size_t term) {
            return static_cast<Eigen::Index>(numbers[term * static_cast<std::size_t>(size)]);
        };
        for (std::size_t a = 0; a < terms; ++a)
            for (std::size_t b = 0; b < terms; ++b)
                sum += rotated_mean(lights[a], lights[b], references.block(first(a), first(b), size, size));
    }
    return sum;
}

/// Light below this fraction of `references` is rounding error, because the vectors are floats.
constexpr double kRoundingOfFloats = 1e-6 * 1e-6;

/// Returns the minimum square of exit radiance to which errors are relative.
double least_square(const ErrorMoments& moments, const Lighting& lighting) {
    const auto n = static_cast<Eigen::Index>(moments.layout.dimension());
    double energy = 0;
    for (const glm::vec3& column : light_columns(moments.layout, lighting))
        energy += static_cast<double>(glm::dot(column, column));
    const double possible = energy * Eigen::Map<const Matrix>(moments.references.data(), n, n).trace();
    return kAdaptationShare * kAdaptationShare *
           std::max(mean_square_over_rotations(moments, lighting), kRoundingOfFloats * possible);
}

/// A trigonometric polynomial, defined by its values at an odd number of equally spaced angles.
class TrigonometricPolynomial {
public:
    explicit TrigonometricPolynomial(const Eigen::VectorXd& values)
        : cosines_(values.size() / 2 + 1), sines_(values.size() / 2 + 1) {
        for (Eigen::Index m = 0; m < cosines_.size(); ++m) {
            const double scale = (m == 0 ? 1.0 : 2.0) / static_cast<double>(values.size());
            double cosine = 0, sine = 0;
            for (Eigen::Index k = 0; k < values.size(); ++k) {
                const double angle = 2 * pi * static_cast<double>(m * k) / static_cast<double>(values.size());
                cosine += values[k] * std::cos(angle);
                sine += values[k] * std::sin(angle);
            }
            cosines_[m] = scale * cosine;
            sines_[m] = scale * sine;
        }
    }
    double mean() const { return cosines_[0]; }
    double operator()(double angle) const {
        double sum = 0;
        for (Eigen::Index m = 0; m < cosines_.size(); ++m)
            sum += cosines_[m] * std::cos(static_cast<double>(m) * angle) +
                   sines_[m] * std::sin(static_cast<double>(m) * angle);
        return sum;
    }

private:
    Eigen::VectorXd cosines_, sines_;
};

/// Returns the position of the maximum of `f` in [low, high] by golden section search; of a local one if
/// there are several.
double position_of_maximum(auto&& f, double low, double high) {
    constexpr double kGolden = 0.6180339887498949;
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    double at_a = f(a), at_b = f(b);
    constexpr int kSteps = 40; // to 1e-8 of the interval, which is rounding at a maximum
    for (int step = 0; step < kSteps; ++step) {
        if (at_a > at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - kGolden * (high - low);
            at_a = f(a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + kGolden * (high - low);
            at_b = f(b);
        }
    }
    return at_a > at_b ? a : b;
}

} // namespace

std::vector<double> second_moments(const TransferView& transfer, std::span<const float> areas, int threads) {
    return sums_of_squares(transfer.dimension(), areas, threads,
                           [&](std::size_t begin, std::size_t end) -> Matrix {
                               return columns_of(transfer, begin, end).cast<double>();
                           });
}

ErrorMoments error_moments(const TransferView& reference, const TransferView& approximation,
                           std::span<const float> areas, std::vector<double> references, int threads) {
    if (reference.layout() != approximation.layout() || reference.receivers() != approximation.receivers())
        throw Error("the transfers have different orders, terms or numbers of receivers");
    return {reference.layout(),
            sums_of_squares(reference.dimension(), areas, threads,
                            [&](std::size_t begin, std::size_t end) -> Matrix {
                                return columns_of(reference, begin, end).cast<double>() -
                                       columns_of(approximation, begin, end).cast<double>();
                            }),
            std::move(references)};
}

ErrorMoments error_moments(const TransferView& reference, const TransferView& approximation,
                           std::span<const float> areas, int threads) {
    return error_moments(reference, approximation, areas, second_moments(reference, areas, threads), threads);
}

double lit_rms(const ErrorMoments& moments, const LightingView& lighting) {
    const Squares squares = squares_under(moments, lighting);
    return ratio(squares.error, squares.reference);
}

double expected_lit_rms(const ErrorMoments& moments, const LightMetric& metric) {
    if (metric.layout != moments.layout)
        throw Error("the metric and the transfer have different orders or terms");
    const auto sum_with = [&](const std::vector<double>& of_transfer) {
        return Eigen::Map<const Eigen::VectorXd>(metric.moments.data(),
                                                 static_cast<Eigen::Index>(metric.moments.size()))
            .dot(Eigen::Map<const Eigen::VectorXd>(of_transfer.data(),
                                                   static_cast<Eigen::Index>(of_transfer.size())));
    };
    return ratio(sum_with(moments.errors), sum_with(moments.references));
}

LitRmsOverRotations lit_rms_over_rotations(const ErrorMoments& moments, const Lighting& lighting) {
    const int order = moments.layout.order, rotations = 4 * order - 3;
    Eigen::VectorXd errors(rotations), references(rotations);
    for (int k = 0; k < rotations; ++k) {
        const Squares squares =
            squares_under(moments, rotated_about_y(lighting, order, 2 * pi * k / rotations));
        errors[k] = squares.error;
        references[k] = squares.reference;
    }
    const TrigonometricPolynomial error(errors), reference(references);
    const double least = least_square(moments, lighting);
    const auto at = [&](double angle) { return ratio(error(angle), std::max(reference(angle), least)); };
    LitRmsOverRotations result{ratio(error.mean(), std::max(reference.mean(), least))};
    // A polynomial of degree d has at most 2d maxima, so that neighbours on a grid of 16 d enclose one.
    const double step = 2 * pi / (32 * order);
    int best = 0;
    for (int k = 1; k < 32 * order; ++k)
        if (at(k * step) > at(best * step))
            best = k;
    result.worst_angle = position_of_maximum(at, (best - 1) * step, (best + 1) * step);
    result.worst = at(result.worst_angle);
    return result;
}

} // namespace prt

#include "metric/frame.h"

#include "prt/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

struct Moments {
    Vector sum;
    Matrix outer;
};

/// Weighted first and second moments of all vectors about `shift`, block by block in double and summed in a
/// fixed order.
Moments weighted_moments(const Transfer& transfer, std::span<const float> weights, const Vector& shift,
                         int threads) {
    const auto n = static_cast<Eigen::Index>(transfer.dimension());
    // At most 64 partial sums, whatever the number of receivers.
    const std::size_t grain = std::max<std::size_t>(1024, (transfer.receivers() + 63) / 64);
    std::vector<Moments> parts((transfer.receivers() + grain - 1) / grain);
    parallel_for(transfer.receivers(), grain, threads, [&](std::size_t begin, std::size_t end) {
        Moments& part = parts[begin / grain];
        part = {Vector::Zero(n), Matrix::Zero(n, n)};
        constexpr std::size_t kRows = 256;
        Matrix rows(n, static_cast<Eigen::Index>(kRows));
        for (std::size_t first = begin; first < end; first += kRows) {
            const std::size_t count = std::min(kRows, end - first);
            for (std::size_t r = 0; r < count; ++r) {
                const Eigen::Map<const Eigen::VectorXf> vector(transfer.vector(first + r).data(), n);
                const double weight = static_cast<double>(weights[first + r]);
                rows.col(static_cast<Eigen::Index>(r)) = (vector.cast<double>() - shift) * std::sqrt(weight);
                part.sum += rows.col(static_cast<Eigen::Index>(r)) * std::sqrt(weight);
            }
            part.outer.selfadjointView<Eigen::Lower>().rankUpdate(
                rows.leftCols(static_cast<Eigen::Index>(count)));
        }
    });
    Moments total{Vector::Zero(n), Matrix::Zero(n, n)};
    for (const Moments& part : parts) {
        total.sum += part.sum;
        total.outer += part.outer;
    }
    total.outer = Matrix(total.outer.selfadjointView<Eigen::Lower>());
    return total;
}

/// The weights, scaled to the sum 1 again, without receivers whose vector is more than a hundred times as
/// long as the median: near one such, float has no digits left for the others.
std::vector<float> without_outliers(const Transfer& transfer, std::span<const float> weights) {
    std::vector<float> lengths;
    for (std::size_t p = 0; p < weights.size(); ++p)
        lengths.push_back(Eigen::Map<const Eigen::VectorXf>(transfer.vector(p).data(),
                                                            static_cast<Eigen::Index>(transfer.dimension()))
                              .stableNorm());
    std::vector<float> sorted = lengths;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    std::vector<float> usual(weights.begin(), weights.end());
    double total = 0;
    for (std::size_t p = 0; p < usual.size(); ++p) {
        if (lengths[p] > 100 * *middle)
            usual[p] = 0;
        total += static_cast<double>(usual[p]);
    }
    if (!(total > 0))
        return {weights.begin(), weights.end()};
    for (float& weight : usual)
        weight = static_cast<float>(static_cast<double>(weight) / total);
    return usual;
}

/// The symmetric square root of the metric, block by block, and its inverse.
void square_roots(const LightMetric& metric, Matrix& root, Matrix& inverse) {
    const auto count = static_cast<Eigen::Index>(metric.order * metric.order);
    root = Matrix::Zero(count * metric.channels, count * metric.channels);
    inverse = root;
    for (int c = 0; c < metric.channels; ++c) {
        const Eigen::Map<const Matrix> moments(&metric.moments[static_cast<std::size_t>(c * count * count)],
                                               count, count);
        const Eigen::SelfAdjointEigenSolver<Matrix> solver(moments);
        root.block(c * count, c * count, count, count) = solver.operatorSqrt();
        inverse.block(c * count, c * count, count, count) = solver.operatorInverseSqrt();
    }
}

} // namespace

Frame fit_frame(const Transfer& transfer, std::span<const float> weights, const LightMetric& metric,
                double most_dropped, int threads) {
    const auto n = static_cast<Eigen::Index>(transfer.dimension());
    Matrix root, inverse;
    square_roots(metric, root, inverse);
    const std::vector<float> usual = without_outliers(transfer, weights);
    const Vector origin = weighted_moments(transfer, usual, Vector::Zero(n), threads).sum;
    const Moments moments = weighted_moments(transfer, weights, origin, threads);
    const Matrix covariance = root * (moments.outer - moments.sum * moments.sum.transpose()) * root;
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance);
    const double energy = (root * (origin + moments.sum)).squaredNorm() + std::max(covariance.trace(), 0.0);
    const double scale = energy > 0 ? 1 / std::sqrt(energy) : 1;

    Frame frame{transfer.order, transfer.channels, 0, {}, {}, {}, {}, 0, scale};
    frame.origin.assign(origin.begin(), origin.end());
    frame.variances.resize(static_cast<std::size_t>(n));
    for (Eigen::Index i = 0; i < n; ++i) // eigenvalues ascend
        frame.variances[static_cast<std::size_t>(i)] =
            std::max(0.0, solver.eigenvalues()[n - 1 - i]) * scale * scale;
    // Float rounding of usual vectors alone makes (2^-24)² of their energy along every axis; 4 is a margin.
    const double rounding = 4 * 0x1p-48 * scale * scale * (root * origin).squaredNorm();
    frame.dimension = static_cast<std::size_t>(n);
    // Beside an outlier's the variances of all others are too inexact to tell which axes matter.
    bool outliers = false;
    for (std::size_t p = 0; p < usual.size(); ++p)
        outliers = outliers || (usual[p] == 0 && weights[p] > 0);
    while (frame.dimension > 0 && !outliers) {
        const double variance = frame.variances[frame.dimension - 1];
        if (frame.dropped + variance > most_dropped && variance > rounding)
            break;
        frame.dropped += variance;
        --frame.dimension;
    }
    const auto kept = static_cast<Eigen::Index>(frame.dimension);
    Matrix axes = solver.eigenvectors().rightCols(kept).rowwise().reverse();
    for (Eigen::Index i = 0; i < kept; ++i) { // the sign of an eigenvector is arbitrary; fix it
        Eigen::Index largest = 0;
        axes.col(i).cwiseAbs().maxCoeff(&largest);
        if (axes(largest, i) < 0)
            axes.col(i) *= -1;
    }
    const Matrix analysis = scale * root * axes,
                 synthesis = inverse * axes / scale; // [full][kept], column-major
    frame.analysis.assign(analysis.data(), analysis.data() + analysis.size());
    frame.synthesis.assign(synthesis.data(), synthesis.data() + synthesis.size());
    return frame;
}

void truncate(Frame& frame, std::size_t dimension) {
    for (std::size_t i = dimension; i < frame.dimension; ++i)
        frame.dropped += frame.variances[i];
    frame.dimension = dimension;
    frame.analysis.resize(dimension * frame.full());
    frame.synthesis.resize(dimension * frame.full());
}

} // namespace prt

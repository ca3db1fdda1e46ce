// Computes principal axes of transfer in the metric of light (docs/math.md, section 4), so that clustering
// needs few dimensions.

#include "compress/metric/frame.h"

#include "compress/metric/transfer_columns.h"
#include "compress/tuning/tuning.h"
#include "runtime/core/support/parallel.h"

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

/// Returns first and second moments of all vectors about `shift`, weighted by significance, block by block in
/// double, summed in a fixed order.
Moments moments_about(const Vector& shift, const TransferView& transfer, std::span<const float> significance,
                      int threads) {
    const auto n = static_cast<Eigen::Index>(transfer.dimension());
    // At most 64 partial sums for any number of receivers.
    const std::size_t grain = std::max<std::size_t>(1024, (transfer.receivers() + 63) / 64);
    std::vector<Moments> terms((transfer.receivers() + grain - 1) / grain);
    parallel_for(transfer.receivers(), grain, threads, [&](std::size_t begin, std::size_t end) {
        Moments& term = terms[begin / grain];
        term = {Vector::Zero(n), Matrix::Zero(n, n)};
        constexpr std::size_t kRows = 256;
        Matrix rows(n, static_cast<Eigen::Index>(kRows));
        for (std::size_t first = begin; first < end; first += kRows) {
            const std::size_t count = std::min(kRows, end - first);
            const Eigen::MatrixXf vectors = columns_of(transfer, first, first + count);
            for (std::size_t r = 0; r < count; ++r) {
                const auto vector = vectors.col(static_cast<Eigen::Index>(r));
                const double root = std::sqrt(static_cast<double>(significance[first + r]));
                rows.col(static_cast<Eigen::Index>(r)) = (vector.cast<double>() - shift) * root;
                term.sum += rows.col(static_cast<Eigen::Index>(r)) * root;
            }
            term.outer.selfadjointView<Eigen::Lower>().rankUpdate(
                rows.leftCols(static_cast<Eigen::Index>(count)));
        }
    });
    Moments total{Vector::Zero(n), Matrix::Zero(n, n)};
    for (const Moments& term : terms) {
        total.sum += term.sum;
        total.outer += term.outer;
    }
    total.outer = Matrix(total.outer.selfadjointView<Eigen::Lower>());
    return total;
}

/// Returns the mean of all vectors, weighted by significance of sum 1; each block is in double, and blocks
/// are summed in order.
Vector mean_of(const TransferView& transfer, std::span<const float> significance) {
    Vector sum = Vector::Zero(static_cast<Eigen::Index>(transfer.dimension()));
    constexpr std::size_t kRead = 256;
    for (std::size_t begin = 0; begin < significance.size(); begin += kRead) {
        const std::size_t end = std::min(begin + kRead, significance.size());
        const Eigen::Map<const Eigen::VectorXf> shares(&significance[begin],
                                                       static_cast<Eigen::Index>(end - begin));
        sum += columns_of(transfer, begin, end).cast<double>() * shares.cast<double>();
    }
    return sum;
}

/// Returns the significance without outliers, whose vectors are far longer than the median, rescaled to sum
/// 1.
std::vector<float> without_outliers(const TransferView& transfer, std::span<const float> significance) {
    std::vector<float> lengths(significance.size());
    constexpr std::size_t kRead = 256;
    for (std::size_t begin = 0; begin < lengths.size(); begin += kRead) {
        const std::size_t end = std::min(begin + kRead, lengths.size());
        const Eigen::MatrixXf vectors = columns_of(transfer, begin, end);
        for (std::size_t p = begin; p < end; ++p)
            lengths[p] = vectors.col(static_cast<Eigen::Index>(p - begin)).stableNorm();
    }
    std::vector<float> sorted = lengths;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    std::vector<float> usual(significance.begin(), significance.end());
    double total = 0;
    for (std::size_t p = 0; p < usual.size(); ++p) {
        if (lengths[p] > tuning::kOutlierLength * *middle)
            usual[p] = 0;
        total += static_cast<double>(usual[p]);
    }
    if (!(total > 0))
        return {significance.begin(), significance.end()};
    for (float& share : usual)
        share = static_cast<float>(static_cast<double>(share) / total);
    return usual;
}

/// Computes the symmetric square root of the metric and its inverse.
void square_roots(const LightMetric& metric, Matrix& root, Matrix& inverse) {
    const auto n = static_cast<Eigen::Index>(metric.layout.dimension());
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(Eigen::Map<const Matrix>(metric.moments.data(), n, n));
    root = solver.operatorSqrt();
    inverse = solver.operatorInverseSqrt();
}

/// Drops axes from the end while they add at most `max_dropped`, are only `rounding`, or exceed the maximum
/// dimension of points.
void drop_axes(Frame& frame, double max_dropped, double rounding) {
    while (frame.dimension > 0) {
        const double variance = frame.variances[frame.dimension - 1];
        if (frame.dropped + variance > max_dropped && variance > rounding &&
            frame.dimension <= kMaxTransferNumbers)
            break;
        frame.dropped += variance;
        --frame.dimension;
    }
}

/// Returns the last `count` eigenvectors, largest first. The largest entry of each is made positive, because
/// the sign is arbitrary.
Matrix largest_axes(const Matrix& eigenvectors, std::size_t count) {
    Matrix axes = eigenvectors.rightCols(static_cast<Eigen::Index>(count)).rowwise().reverse();
    for (Eigen::Index i = 0; i < axes.cols(); ++i) {
        Eigen::Index largest = 0;
        axes.col(i).cwiseAbs().maxCoeff(&largest);
        if (axes(largest, i) < 0)
            axes.col(i) *= -1;
    }
    return axes;
}

} // namespace

Frame fit_frame(const TransferView& transfer, std::span<const float> significance, const LightMetric& metric,
                double max_dropped, int threads) {
    Matrix root, inverse;
    square_roots(metric, root, inverse);
    const std::vector<float> usual = without_outliers(transfer, significance);
    const Vector origin = mean_of(transfer, usual);
    const Moments moments = moments_about(origin, transfer, significance, threads);
    const Matrix covariance = root * (moments.outer - moments.sum * moments.sum.transpose()) * root;
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance);
    const double energy = (root * (origin + moments.sum)).squaredNorm() + std::max(covariance.trace(), 0.0);
    const double scale = energy > 0 ? 1 / std::sqrt(energy) : 1;

    Frame frame{transfer.layout(), transfer.dimension(), {}, {}, {}, {}, 0, scale};
    frame.origin.assign(origin.begin(), origin.end());
    for (Eigen::Index i = covariance.cols(); i-- > 0;) // eigenvalues are in ascending order
        frame.variances.push_back(std::max(0.0, solver.eigenvalues()[i]) * scale * scale);
    // Next to an outlier's variance, those of all others are too inexact to decide which axes matter.
    bool outliers = false;
    for (std::size_t p = 0; p < usual.size(); ++p)
        outliers = outliers || (usual[p] == 0 && significance[p] > 0);
    // Float rounding of ordinary vectors alone causes (2^-24)² of their energy along every axis; 4 is a
    // margin.
    if (outliers)
        drop_axes(frame, -1, -1);
    else
        drop_axes(frame, max_dropped, 4 * 0x1p-48 * scale * scale * (root * origin).squaredNorm());
    const Matrix axes = largest_axes(solver.eigenvectors(), frame.dimension);
    const Matrix analysis = scale * root * axes,
                 synthesis = inverse * axes / scale; // [full][kept], column-major
    frame.analysis.assign(analysis.data(), analysis.data() + analysis.size());
    frame.synthesis.assign(synthesis.data(), synthesis.data() + synthesis.size());
    return frame;
}

std::size_t axes_needed(const Frame& frame, double most) {
    std::size_t axes = frame.dimension;
    double dropped = frame.dropped;
    while (axes > 0 && dropped + frame.variances[axes - 1] <= most)
        dropped += frame.variances[--axes];
    return axes;
}

void truncate(Frame& frame, std::size_t dimension) {
    for (std::size_t i = dimension; i < frame.dimension; ++i)
        frame.dropped += frame.variances[i];
    frame.dimension = dimension;
    frame.analysis.resize(dimension * frame.full());
    frame.synthesis.resize(dimension * frame.full());
}

} // namespace prt

// Weights errors under skies by the local light (docs/math.md, eq. 28c).

#include "compress/metric/sky_contrast.h"

#include "compress/metric/transfer_columns.h"
#include "compress/tuning/tuning.h"
#include "prt/core/error_measures.h"
#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Calls `visit(receiver, vectors)` with the sky coefficients of `a`, or of a minus `b` if given.
template <class Visit>
void for_sky_columns(const TransferView& a, const TransferView* b, int threads, Visit visit) {
    constexpr std::size_t kGrain = 1024;
    const auto sky = static_cast<Eigen::Index>(a.layout().distant_numbers());
    parallel_for(a.receivers(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
        Eigen::MatrixXd columns = columns_of(a, begin, end).topRows(sky).cast<double>();
        if (b)
            columns -= columns_of(*b, begin, end).topRows(sky).cast<double>();
        visit(begin, columns);
    });
}

/// Returns the expected squared light of each receiver.
std::vector<double> expected_squares(const TransferView& a, const TransferView* b, const LightMetric& metric,
                                     int threads) {
    const auto full = static_cast<Eigen::Index>(metric.layout.dimension());
    const auto sky = static_cast<Eigen::Index>(metric.layout.distant_numbers());
    const Eigen::MatrixXd moments =
        Eigen::Map<const Eigen::MatrixXd>(metric.moments.data(), full, full).topLeftCorner(sky, sky);
    std::vector<double> squares(a.receivers());
    for_sky_columns(a, b, threads, [&](std::size_t begin, const Eigen::MatrixXd& columns) {
        const Eigen::VectorXd of_block = columns.cwiseProduct(moments * columns).colwise().sum();
        for (Eigen::Index i = 0; i < of_block.size(); ++i)
            squares[begin + static_cast<std::size_t>(i)] = std::max(0.0, of_block[i]);
    });
    return squares;
}

} // namespace

SkyContrast::SkyContrast(const TransferView& transfer, std::span<const float> significance,
                         const LightMetric& metric, int threads)
    : transfer_(transfer), significance_(significance), metric_(metric), threads_(threads),
      luminance_(expected_squares(transfer, nullptr, metric, threads)) {
    for (std::size_t p = 0; p < luminance_.size(); ++p) {
        mean_square_ += static_cast<double>(significance[p]) * luminance_[p];
        luminance_[p] = std::sqrt(luminance_[p]);
    }
    adaptation_ = adaptation_luminance(luminance_, significance);
}

std::vector<float> SkyContrast::costs() const {
    std::vector<float> costs(luminance_.size(), 1.0f);
    if (!(adaptation_ > 0))
        return costs;
    constexpr double kShare = tuning::kSkyContrastShare;
    for (std::size_t p = 0; p < costs.size(); ++p) {
        const double seen = luminance_[p] + adaptation_;
        costs[p] = static_cast<float>(1 - kShare + kShare * mean_square_ / (seen * seen));
    }
    return costs;
}

double SkyContrast::contrast(const TransferView& approximation) const {
    if (!(adaptation_ > 0))
        return 0;
    const std::vector<double> squares = expected_squares(transfer_, &approximation, metric_, threads_);
    double sum = 0;
    for (std::size_t p = 0; p < squares.size(); ++p) {
        const double seen = luminance_[p] + adaptation_;
        sum += static_cast<double>(significance_[p]) * squares[p] / (seen * seen);
    }
    return std::sqrt(sum);
}

} // namespace prt

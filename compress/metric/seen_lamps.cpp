// Contrast of lamps: weights of errors, and a space in which they are distances (docs/math.md, section 4).

#include "compress/metric/seen_lamps.h"

#include "compress/metric/transfer_columns.h"
#include "compress/tuning/tuning.h"
#include "prt/core/error_measures.h"
#include "prt/core/light.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

double luminance_share(std::size_t channel, std::size_t channels) {
    return channels == 3 ? kLuminance[static_cast<glm::length_t>(channel)] : 1;
}

/// Returns the term of `transfer` that the sky lights: the first coefficients of each vector.
TransferView sky_of(const TransferView& transfer) {
    TransferLayout layout = transfer.layout();
    layout.terms.assign(transfer.layout().distant_terms().begin(), transfer.layout().distant_terms().end());
    const std::size_t kept = layout.dimension();
    return {layout, transfer.receivers(), [&transfer, kept](std::size_t first, std::span<float> to) {
                const std::size_t count = to.size() / kept, full = transfer.dimension();
                std::vector<float> whole(count * full);
                transfer.read(first, whole);
                for (std::size_t p = 0; p < count; ++p)
                    std::copy_n(&whole[p * full], kept, &to[p * kept]);
            }};
}

/// Calls `visit(receiver, vector)` for all receivers in order.
template <class Visit>
void for_vectors(const TransferView& transfer, Visit&& visit) {
    constexpr std::size_t kRead = 256;
    for (std::size_t begin = 0; begin < transfer.receivers(); begin += kRead) {
        const Eigen::MatrixXf vectors =
            columns_of(transfer, begin, std::min(begin + kRead, transfer.receivers()));
        for (Eigen::Index c = 0; c < vectors.cols(); ++c)
            visit(begin + static_cast<std::size_t>(c), vectors.col(c).data());
    }
}

} // namespace

SeenLamps::SeenLamps(const TransferView& transfer, std::span<const float> significance,
                     const LightMetric& metric, int threads)
    : transfer_(transfer), significance_(significance) {
    const TransferLayout& layout = transfer.layout();
    const std::size_t full = layout.dimension(), sky = layout.distant_numbers();
    std::size_t first = sky;
    for (const TransferTerm& term : layout.lamp_terms()) {
        lamps_.push_back({first, static_cast<std::size_t>(term.channels)});
        first += lamps_.back().channels;
    }
    measure_lamps();
    metric_ = {layout, std::vector<double>(full * full, 0)};
    if (sky > 0) {
        const TransferView of_sky = sky_of(transfer);
        LightMetric block{of_sky.layout(), std::vector<double>(sky * sky)};
        for (std::size_t i = 0; i < sky; ++i)
            std::copy_n(&metric.moments[i * full], sky, &block.moments[i * sky]);
        sky_ = fit_frame(of_sky, significance, block, 0, threads);
        for (std::size_t i = 0; i < sky; ++i)
            for (std::size_t j = 0; j < sky; ++j)
                metric_.moments[i * full + j] = sky_->scale * sky_->scale * block.moments[i * sky + j];
    }
    for (const Lamp& lamp : lamps_)
        for (std::size_t c = 0; c < lamp.channels; ++c)
            metric_.moments[(lamp.first + c) * (full + 1)] = tuning::kLampsShare *
                                                             luminance_share(c, lamp.channels) /
                                                             static_cast<double>(std::max(shining(), 1));
}

void SeenLamps::measure_lamps() {
    std::vector<std::vector<double>> luminances(lamps_.size(), std::vector<double>(transfer_.receivers()));
    for_vectors(transfer_, [&](std::size_t p, const float* vector) {
        for (std::size_t l = 0; l < lamps_.size(); ++l) {
            const double y = luminances[l][p] = luminance(lamps_[l], vector);
            lamps_[l].square += static_cast<double>(significance_[p]) * y * y;
        }
    });
    for (std::size_t l = 0; l < lamps_.size(); ++l)
        lamps_[l].adaptation = adaptation_luminance(luminances[l], significance_);
}

int SeenLamps::shining() const {
    return static_cast<int>(
        std::ranges::count_if(lamps_, [](const Lamp& lamp) { return lamp.adaptation > 0; }));
}

double SeenLamps::luminance(const Lamp& lamp, const float* vector) const {
    double y = 0;
    for (std::size_t c = 0; c < lamp.channels; ++c)
        y += luminance_share(c, lamp.channels) * static_cast<double>(vector[lamp.first + c]);
    return std::abs(y);
}

double SeenLamps::cost(const Lamp& lamp, double y) const {
    const double seen = y + lamp.adaptation;
    return 1 / (seen * seen) + tuning::kSpotsShare / lamp.square;
}

TransferView SeenLamps::logarithmic() const {
    return {transfer_.layout(), transfer_.receivers(), [this](std::size_t first, std::span<float> to) {
                transfer_.read(first, to);
                for (std::size_t begin = 0; begin < to.size(); begin += transfer_.dimension())
                    for (const Lamp& lamp : lamps_) {
                        const double y = luminance(lamp, &to[begin]), a = lamp.adaptation,
                                     spots = a > 0 ? std::sqrt(tuning::kSpotsShare / lamp.square) : 0,
                                     logarithm = !(a > 0)       ? 0
                                                 : y > 1e-6 * a ? std::log1p(y / a) / y
                                                                : 1 / a;
                        const double factor = logarithm + spots;
                        for (std::size_t c = 0; c < lamp.channels; ++c)
                            to[begin + lamp.first + c] =
                                static_cast<float>(factor * static_cast<double>(to[begin + lamp.first + c]));
                    }
            }};
}

void SeenLamps::add_axes_of(const Lamp& lamp, Frame& frame) const {
    const auto n = static_cast<Eigen::Index>(lamp.channels);
    const std::size_t full = transfer_.dimension();
    Eigen::ArrayXd roots(n);
    for (Eigen::Index c = 0; c < n; ++c)
        roots[c] = std::sqrt(metric_.moments[(lamp.first + static_cast<std::size_t>(c)) * (full + 1)]);
    Eigen::MatrixXd outer = Eigen::MatrixXd::Zero(n, n);
    for_vectors(transfer_, [&](std::size_t p, const float* vector) {
        const Eigen::VectorXd seen = roots *
                                     Eigen::Map<const Eigen::ArrayXf>(vector + lamp.first, n).cast<double>() *
                                     std::sqrt(cost(lamp, luminance(lamp, vector)));
        outer += static_cast<double>(significance_[p]) * seen * seen.transpose();
    });
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(outer);
    for (Eigen::Index i = n; i-- > 0;) { // eigenvalues are in ascending order
        const double variance = std::max(solver.eigenvalues()[i], 0.0);
        if (i < n - 1 && variance <= tuning::kMinColor * solver.eigenvalues()[n - 1]) {
            frame.dropped += variance;
            continue;
        }
        frame.variances.push_back(std::max(variance, 1e-30));
        frame.analysis.resize(frame.analysis.size() + full, 0.0);
        frame.synthesis.resize(frame.synthesis.size() + full, 0.0);
        for (Eigen::Index c = 0; c < n; ++c) {
            const std::size_t at = frame.dimension * full + lamp.first + static_cast<std::size_t>(c);
            frame.analysis[at] = solver.eigenvectors()(c, i) * roots[c];
            frame.synthesis[at] = solver.eigenvectors()(c, i) / roots[c];
        }
        ++frame.dimension;
    }
}

Frame SeenLamps::frame(double max_dropped) const {
    const std::size_t full = transfer_.dimension();
    Frame frame{transfer_.layout(), 0, std::vector<double>(full, 0.0), {}, {}, {}, 0, 1};
    for (const Lamp& lamp : lamps_)
        if (lamp.adaptation > 0)
            add_axes_of(lamp, frame);
    if (sky_) {
        std::ranges::copy(sky_->origin, frame.origin.begin());
        for (std::size_t i = 0; i < sky_->dimension && frame.dimension < kMaxTransferNumbers; ++i) {
            frame.variances.push_back(sky_->variances[i]);
            frame.analysis.resize(frame.analysis.size() + full, 0.0);
            frame.synthesis.resize(frame.synthesis.size() + full, 0.0);
            const std::size_t sky = sky_->full(), to = frame.dimension++ * full;
            std::copy_n(&sky_->analysis[i * sky], sky, &frame.analysis[to]);
            std::copy_n(&sky_->synthesis[i * sky], sky, &frame.synthesis[to]);
        }
    }
    truncate(frame, axes_needed(frame, max_dropped));
    return frame;
}

double SeenLamps::contrast(const TransferView& approximation) const {
    double squares = 0;
    std::vector<float> other(transfer_.dimension());
    for_vectors(transfer_, [&](std::size_t p, const float* vector) {
        approximation.read(p, other);
        for (const Lamp& lamp : lamps_) {
            const double seen = luminance(lamp, vector) + lamp.adaptation;
            for (std::size_t c = 0; c < (lamp.adaptation > 0 ? lamp.channels : 0); ++c) {
                const double error = static_cast<double>(vector[lamp.first + c] - other[lamp.first + c]);
                squares += static_cast<double>(significance_[p]) * luminance_share(c, lamp.channels) * error *
                           error / (seen * seen);
            }
        }
    });
    return shining() > 0 ? std::sqrt(squares / shining()) : 0;
}

PointScales SeenLamps::scales(const Frame& frame, std::span<const float> sky_costs) const {
    PointScales result;
    std::vector<const Lamp*> of_groups;
    const std::size_t full = frame.full();
    for (std::size_t i = 0; i < frame.dimension; ++i) {
        const double* axis = &frame.synthesis[i * full];
        const Lamp* of_axis = nullptr;
        for (const Lamp& lamp : lamps_)
            if (std::any_of(axis + lamp.first, axis + lamp.first + lamp.channels,
                            [](double v) { return v != 0; }))
                of_axis = &lamp;
        if (of_groups.empty() || of_groups.back() != of_axis)
            of_groups.push_back(of_axis);
        result.group_of.push_back(static_cast<std::uint8_t>(of_groups.size() - 1));
    }
    result.groups = of_groups.size();
    result.scales.resize(transfer_.receivers() * result.groups, 1);
    for_vectors(transfer_, [&](std::size_t p, const float* vector) {
        for (std::size_t g = 0; g < result.groups; ++g)
            result.scales[p * result.groups + g] =
                of_groups[g]
                    ? static_cast<float>(std::sqrt(cost(*of_groups[g], luminance(*of_groups[g], vector))))
                    : std::sqrt(sky_costs[p]);
    });
    return result;
}

} // namespace prt

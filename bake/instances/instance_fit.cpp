// Fits the modes of an instance to samples. Unknowns: of each passing mode its row (x, y, z, 1), then of each
// added mode a number per channel.

#include "instances/instance_fit.h"

#include "prt/light.h"
#include "prt/sh_basis.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace prt {
namespace {

constexpr Eigen::Index kPassingUnknowns = 4 * kPassingModes;
/// What keeps factors of what samples do not tell at those of the open, against the mean of the normal
/// matrix.
constexpr double kRidge = 1e-4;

/// Lighting that is less certain the finer it is, band by band: 1 / (l + 1).
float band_weight(std::size_t coefficient) {
    const auto band = static_cast<float>(std::floor(std::sqrt(static_cast<double>(coefficient))));
    return 1 / (band + 1);
}

/// Overcast, and broad light from four sides, in a frame where `up` is.
std::vector<Light> soft_skies(int order, const glm::dvec3& up) {
    const glm::dvec3 other = std::abs(up.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 across = glm::normalize(glm::cross(up, other)), along = glm::cross(across, up);
    std::vector<Light> skies = {hemisphere_light(order, glm::vec3(up), glm::vec3(1), glm::vec3(0.1f))};
    for (const glm::dvec3& side : {across, -across, along, -along})
        skies.push_back(
            hemisphere_light(order, glm::vec3(glm::normalize(side + up)), glm::vec3(1), glm::vec3(0)));
    return skies;
}

} // namespace

InstanceFit::InstanceFit(const SharedTransfer& shared, const InstanceSamples& samples, const glm::dvec3& up)
    : samples_(samples.receivers.size()) {
    const TransferLayout& layout = shared.layout();
    const auto count = static_cast<Eigen::Index>(shared.level().size());
    const auto dimension = static_cast<Eigen::Index>(layout.dimension());
    added_ = layout.parts.back().kind != PartKind::direct;
    channels_ = layout.parts.back().channels;
    const Eigen::Index unknowns =
        kPassingUnknowns + (added_ ? static_cast<Eigen::Index>(kAddedModes) * channels_ : 0);
    weights_.resize(dimension);
    for (Eigen::Index i = 0; i < dimension; ++i)
        weights_[i] = band_weight(static_cast<std::size_t>(i % count));
    columns_ = Eigen::MatrixXf::Zero(static_cast<Eigen::Index>(samples_) * dimension, unknowns);
    for (std::size_t s = 0; s < samples_; ++s) {
        const std::size_t receiver = samples.receivers[s];
        auto rows = columns_.middleRows(static_cast<Eigen::Index>(s) * dimension, dimension);
        const glm::vec4 place(samples.places[s], 1);
        for (std::size_t m = 0; m < kPassingModes; ++m) {
            const Eigen::Map<const Eigen::VectorXf> mode(shared.passing(receiver, m).data(), dimension);
            for (int a = 0; a < 4; ++a)
                rows.col(static_cast<Eigen::Index>(4 * m) + a) = place[a] * mode.cwiseProduct(weights_);
        }
        for (Eigen::Index c = 0; added_ && c < channels_; ++c)
            for (std::size_t k = 0; k < kAddedModes; ++k)
                for (Eigen::Index i = 0; i < count; ++i) {
                    const Eigen::Index row = dimension - (channels_ - c) * count + i;
                    rows(row, kPassingUnknowns + static_cast<Eigen::Index>(k) * channels_ + c) =
                        weights_[row] * shared.responses(receiver)[k][static_cast<int>(c)] *
                        shared.level()[static_cast<std::size_t>(i)];
                }
    }
    normal_ = (columns_.transpose() * columns_).cast<double>();
    open_ = Eigen::VectorXd::Zero(unknowns);
    open_[3] = open_[kPassingUnknowns - 1] = 1;
    const std::vector<Light> lights = soft_skies(layout.order, up);
    skies_ = Eigen::MatrixXf::Zero(dimension, static_cast<Eigen::Index>(3 * lights.size()));
    for (std::size_t l = 0; l < lights.size(); ++l) {
        Eigen::Index first = 0;
        for (const TransferPart& part : layout.parts)
            for (int c = 0; c < part.channels; ++c, first += count)
                for (int color = part.channels == 1 ? 0 : c; color <= (part.channels == 1 ? 2 : c); ++color)
                    for (Eigen::Index i = 0; i < count; ++i)
                        skies_(first + i, static_cast<Eigen::Index>(3 * l) + color) =
                            lights[l].coefficients[static_cast<std::size_t>(i)].x / weights_[first + i];
    }
}

InstanceFit::Fitted InstanceFit::fit(const Targets& targets) const {
    const auto dimension = weights_.size();
    Eigen::MatrixXd normal = normal_;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(normal.rows());
    for (std::size_t s = 0; s < samples_; ++s) {
        const auto first = static_cast<Eigen::Index>(s) * dimension;
        const auto rows = columns_.middleRows(first, dimension);
        if (targets.left_out[s]) {
            normal -= (rows.transpose() * rows).cast<double>();
            continue;
        }
        const Eigen::Map<const Eigen::VectorXf> a(&targets.first[static_cast<std::size_t>(first)], dimension),
            b(&targets.second[static_cast<std::size_t>(first)], dimension);
        right += (rows.transpose() * (0.5f * (a + b)).cwiseProduct(weights_)).cast<double>();
    }
    const double ridge = kRidge * normal_.trace() / static_cast<double>(normal.rows()) + 1e-30;
    normal.diagonal().array() += ridge;
    right += ridge * open_;
    const Eigen::VectorXd solution = normal.ldlt().solve(right);
    Fitted fitted;
    for (std::size_t m = 0; m < kPassingModes; ++m)
        for (int a = 0; a < 4; ++a)
            fitted.factors.passing[m][a] = static_cast<float>(solution[static_cast<Eigen::Index>(4 * m) + a]);
    for (std::size_t k = 0; added_ && k < kAddedModes; ++k)
        for (int c = 0; c < 3; ++c)
            fitted.factors.added[k][c] =
                static_cast<float>(solution[kPassingUnknowns + static_cast<Eigen::Index>(k) * channels_ +
                                            (channels_ == 1 ? 0 : c)]);
    fitted.error = error(targets, solution);
    return fitted;
}

double InstanceFit::error(const Targets& targets, const Eigen::VectorXd& solution) const {
    const auto dimension = weights_.size();
    const Eigen::VectorXf modelled = columns_ * solution.cast<float>();
    double wrong = 0, noise = 0, all = 0;
    for (std::size_t s = 0; s < samples_; ++s) {
        if (targets.left_out[s])
            continue;
        const auto first = static_cast<Eigen::Index>(s) * dimension;
        const Eigen::Map<const Eigen::VectorXf> a(&targets.first[static_cast<std::size_t>(first)], dimension),
            b(&targets.second[static_cast<std::size_t>(first)], dimension);
        const Eigen::VectorXf mean = (0.5f * (a + b)).cwiseProduct(weights_),
                              half = (0.5f * (a - b)).cwiseProduct(weights_);
        wrong += static_cast<double>(
            (skies_.transpose() * (mean - modelled.segment(first, dimension))).squaredNorm());
        noise += static_cast<double>((skies_.transpose() * half).squaredNorm());
        all += static_cast<double>((skies_.transpose() * mean).squaredNorm());
    }
    return all > 0 ? std::sqrt(std::max(0.0, wrong - noise) / all) : 0;
}

} // namespace prt

// Fits the modes of an instance to samples. Unknowns: for each passing mode a row of four (x, y, z, 1), then
// for each added mode a number per channel. Products of the samples' light with modes are computed before
// those with positions.

#include "bake/products/instances/instance_fit.h"

#include "prt/core/light.h"
#include "prt/core/sh_basis.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace prt {
namespace {

constexpr Eigen::Index kPassingUnknowns = 4 * kPassingModes;
/// Regularisation that keeps undetermined factors at those of an unoccluded instance, relative to the mean of
/// the normal matrix.
constexpr double kRidge = 1e-4;
/// Receivers that would exceed the bound are held to it by rows of this weight, relative to the same mean; at
/// most kMaxHeld receivers per step, and at most kMaxBoundSteps steps. The remaining excess then scales
/// down all factors.
constexpr double kHeld = 4;
constexpr std::size_t kMaxHeld = 16;
constexpr int kMaxBoundSteps = 4;

/// Weight of a coefficient: skies have less energy in higher bands, so that band l has weight 1 / sqrt(l +
/// 1).
float band_weight(std::size_t coefficient) {
    const auto band = static_cast<float>(std::floor(std::sqrt(static_cast<double>(coefficient))));
    return 1 / std::sqrt(band + 1);
}

/// Skies under which errors are always measured, in a frame with up direction `up`: overcast, and broad light
/// from four sides.
std::vector<Lighting> soft_skies(int order, const glm::dvec3& up) {
    const glm::dvec3 other = std::abs(up.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 across = glm::normalize(glm::cross(up, other)), along = glm::cross(across, up);
    std::vector<Lighting> skies = {{hemisphere_light(order, glm::vec3(up), glm::vec3(1), glm::vec3(0.1f))}};
    for (const glm::dvec3& side : {across, -across, along, -along})
        skies.push_back(
            {hemisphere_light(order, glm::vec3(glm::normalize(side + up)), glm::vec3(1), glm::vec3(0))});
    return skies;
}

/// Radiance per unit of each number of transfer under skies, [dimension][skies · 3 colors].
Eigen::MatrixXf radiance_columns(const TransferLayout& layout, std::span<const Lighting> skies) {
    Eigen::MatrixXf result = Eigen::MatrixXf::Zero(static_cast<Eigen::Index>(layout.dimension()),
                                                   static_cast<Eigen::Index>(3 * skies.size()));
    for (std::size_t l = 0; l < skies.size(); ++l) {
        const std::vector<glm::vec3> columns = light_columns(layout, skies[l]);
        Eigen::Index row = 0;
        std::size_t first = 0;
        for (const TransferTerm& term : layout.terms) {
            const std::size_t count = layout.columns_of(term);
            for (int c = 0; c < term.channels; ++c)
                for (std::size_t i = 0; i < count; ++i, ++row)
                    for (int color = 0; color < 3; ++color)
                        if (term.channels == 1 || color == c)
                            result(row, static_cast<Eigen::Index>(3 * l) + color) = columns[first + i][color];
            first += count;
        }
    }
    return result;
}

} // namespace

InstanceFit::InstanceFit(const SharedTransfer& shared, const InstanceSamples& samples, const glm::dvec3& up)
    : layout_(shared.layout()), samples_(samples) {
    const TransferLayout& layout = layout_;
    const auto count = static_cast<Eigen::Index>(shared.level().size());
    added_ = layout.terms.back().kind != TermKind::direct;
    channels_ = layout.terms.back().channels;
    open_ = Eigen::VectorXd::Zero(kPassingUnknowns +
                                  (added_ ? static_cast<Eigen::Index>(kAddedModes) * channels_ : 0));
    open_ = unknowns_of(open_factors());
    weights_.resize(static_cast<Eigen::Index>(layout.dimension()));
    for (Eigen::Index i = 0; i < dimension(); ++i) {
        const float weight = band_weight(static_cast<std::size_t>(i % count));
        weights_[i] = weight * weight;
    }
    level_ = Eigen::MatrixXf::Zero(dimension(), channels_);
    for (Eigen::Index c = 0; c < channels_; ++c)
        for (Eigen::Index i = 0; i < count; ++i) {
            const Eigen::Index row = dimension() - (channels_ - c) * count + i;
            level_(row, c) = weights_[row] * shared.level()[static_cast<std::size_t>(i)];
        }
    skies_ = radiance_columns(layout, soft_skies(layout.order, up));
    const auto all = static_cast<Eigen::Index>(samples_.receivers.size());
    constexpr auto kModes = static_cast<Eigen::Index>(kPassingModes);
    modes_.resize(dimension(), all * kModes);
    normal_ = Eigen::MatrixXd::Zero(open_.size(), open_.size());
    for (Eigen::Index s = 0; s < all; ++s) {
        const auto sample = static_cast<std::size_t>(s);
        const float area = samples_.areas[sample];
        for (Eigen::Index m = 0; m < kModes; ++m) {
            const std::span<const float> mode =
                shared.passing(samples_.receivers[sample], static_cast<std::size_t>(m));
            modes_.col(s * kModes + m) =
                area * weights_.cwiseProduct(Eigen::Map<const Eigen::VectorXf>(mode.data(), dimension()));
        }
        responses_.push_back(shared.responses(samples_.receivers[sample]));
        const Eigen::MatrixXf columns = columns_of(shared, sample);
        normals_.emplace_back(area * (columns.transpose() * weights_.asDiagonal() * columns));
        normal_ += normals_.back().cast<double>();
    }
}

/// Contribution of each unknown to a sample, [dimension][unknowns].
Eigen::MatrixXf InstanceFit::columns_of(const SharedTransfer& shared, std::size_t sample) const {
    const std::size_t receiver = samples_.receivers[sample];
    const glm::vec4 position(samples_.positions[sample], 1);
    Eigen::MatrixXf columns = Eigen::MatrixXf::Zero(dimension(), open_.size());
    for (std::size_t m = 0; m < kPassingModes; ++m) {
        const Eigen::Map<const Eigen::VectorXf> mode(shared.passing(receiver, m).data(), dimension());
        for (int a = 0; a < 4; ++a)
            columns.col(static_cast<Eigen::Index>(4 * m) + a) = position[a] * mode;
    }
    const auto count = static_cast<Eigen::Index>(shared.level().size());
    const Eigen::Map<const Eigen::VectorXf> level(shared.level().data(), count);
    for (Eigen::Index c = 0; added_ && c < channels_; ++c)
        for (std::size_t k = 0; k < kAddedModes; ++k)
            columns.col(kPassingUnknowns + static_cast<Eigen::Index>(k) * channels_ + c)
                .segment(dimension() - (channels_ - c) * count, count) =
                shared.responses(receiver)[k][static_cast<int>(c)] * level;
    return columns;
}

Eigen::VectorXd InstanceFit::unknowns_of(const InstanceFactors& factors) const {
    Eigen::VectorXd unknowns(open_.size());
    for (std::size_t m = 0; m < kPassingModes; ++m)
        for (int a = 0; a < 4; ++a)
            unknowns[static_cast<Eigen::Index>(4 * m) + a] = static_cast<double>(factors.passing[m][a]);
    for (std::size_t k = 0; added_ && k < kAddedModes; ++k)
        for (int c = 0; c < channels_; ++c)
            unknowns[kPassingUnknowns + static_cast<Eigen::Index>(k) * channels_ + c] =
                static_cast<double>(factors.added[k][c]);
    return unknowns;
}

InstanceFactors InstanceFit::factors_of_unknowns(const Eigen::VectorXd& unknowns) const {
    InstanceFactors factors;
    for (std::size_t m = 0; m < kPassingModes; ++m)
        for (int a = 0; a < 4; ++a)
            factors.passing[m][a] = static_cast<float>(unknowns[static_cast<Eigen::Index>(4 * m) + a]);
    for (std::size_t k = 0; added_ && k < kAddedModes; ++k)
        for (int c = 0; c < 3; ++c)
            factors.added[k][c] =
                static_cast<float>(unknowns[kPassingUnknowns + static_cast<Eigen::Index>(k) * channels_ +
                                            (channels_ == 1 ? 0 : c)]);
    return factors;
}

InstanceFactors InstanceFit::fit(const Targets& targets, const UniformBound* bound) const {
    constexpr auto kModes = static_cast<Eigen::Index>(kPassingModes);
    const auto size = static_cast<std::size_t>(dimension());
    Eigen::MatrixXd normal = normal_;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(open_.size());
    for (std::size_t s = 0; s < samples_.receivers.size(); ++s) {
        if (targets.left_out[s]) {
            normal -= normals_[s].cast<double>();
            continue;
        }
        const auto sample = static_cast<Eigen::Index>(s);
        const Eigen::Map<const Eigen::VectorXf> light(&targets.light[s * size], dimension());
        const Eigen::VectorXf passing = modes_.middleCols(sample * kModes, kModes).transpose() * light;
        const glm::vec4 position(samples_.positions[s], 1);
        for (Eigen::Index m = 0; m < kModes; ++m)
            for (int a = 0; a < 4; ++a)
                right[4 * m + a] += static_cast<double>(position[a] * passing[m]);
        if (!added_)
            continue;
        const Eigen::VectorXf added = samples_.areas[s] * (level_.transpose() * light);
        for (std::size_t k = 0; k < kAddedModes; ++k)
            for (Eigen::Index c = 0; c < channels_; ++c)
                right[kPassingUnknowns + static_cast<Eigen::Index>(k) * channels_ + c] +=
                    static_cast<double>(responses_[s][k][static_cast<int>(c)] * added[c]);
    }
    const double mean = normal_.trace() / static_cast<double>(normal.rows()) + 1e-26;
    normal.diagonal().array() += kRidge * mean;
    right += kRidge * mean * open_;
    InstanceFactors factors = factors_of_unknowns(normal.ldlt().solve(right));
    for (int step = 0; bound && step < kMaxBoundSteps; ++step) {
        const std::vector<InstanceFactors> exceeding = bound->exceeding(factors, kMaxHeld);
        if (exceeding.empty())
            return factors;
        for (const InstanceFactors& row : exceeding) {
            const Eigen::VectorXd held = unknowns_of(row);
            normal += kHeld * mean * held * held.transpose();
            right += kHeld * mean * static_cast<double>(bound->bound()) * held;
        }
        factors = factors_of_unknowns(normal.ldlt().solve(right));
    }
    return bound ? scaled(factors, bound->share(factors)) : factors;
}

double InstanceFit::error(const SharedTransfer& shared, const Targets& targets, const Noise& noise,
                          const InstanceFactors& factors, std::span<const Lighting> lights) const {
    const auto size = static_cast<std::size_t>(dimension());
    const Eigen::MatrixXf of_lights = radiance_columns(layout_, lights);
    Eigen::MatrixXf skies(dimension(), skies_.cols() + of_lights.cols());
    skies << skies_, of_lights;
    Eigen::VectorXd wrong = Eigen::VectorXd::Zero(skies.cols()), all = wrong, noisy = wrong;
    double area = 0, noisy_area = 0;
    const auto add = [&](Eigen::VectorXd& sum, std::size_t sample, const Eigen::VectorXf& vector) {
        sum += static_cast<double>(samples_.areas[sample]) *
               (skies.transpose() * vector).cwiseAbs2().cast<double>();
    };
    std::vector<float> modelled(size);
    for (std::size_t s = 0; s < samples_.receivers.size(); ++s) {
        if (targets.left_out[s])
            continue;
        shared.sum(samples_.receivers[s], mode_factors(factors, samples_.positions[s]), modelled);
        const Eigen::VectorXf light =
            Eigen::Map<const Eigen::VectorXf>(&targets.light[s * size], dimension());
        add(wrong, s, light - Eigen::Map<const Eigen::VectorXf>(modelled.data(), dimension()));
        add(all, s, light);
        area += static_cast<double>(samples_.areas[s]);
    }
    for (std::size_t s = noise.first, n = 0; s < samples_.receivers.size(); s += kSamplesToOfNoise, ++n) {
        if (targets.left_out[s])
            continue;
        add(noisy, s, Eigen::Map<const Eigen::VectorXf>(&noise.differences[n * size], dimension()));
        noisy_area += static_cast<double>(samples_.areas[s]);
    }
    noisy *= noisy_area > 0 ? area / noisy_area : 0;
    // Takes the soft skies together: the maximum of many noisy estimates would be biased by noise.
    double most = 0;
    for (Eigen::Index first = 0, count = skies_.cols(); first < skies.cols(); first += count, count = 3) {
        const double light = all.segment(first, count).sum(),
                     lost = wrong.segment(first, count).sum() - noisy.segment(first, count).sum();
        if (light > 0)
            most = std::max(most, lost / light);
    }
    return std::sqrt(most);
}

} // namespace prt

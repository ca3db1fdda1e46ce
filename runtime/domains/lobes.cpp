// Zonal lobes: coding of axes, rotation, and evaluation under light.

#include "prt/core/lobes.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

namespace prt {
namespace {

constexpr float kMiddle = 127; ///< byte value of an axis coordinate of 0
constexpr std::size_t kMaxCoefficients = kMaxLobeOrder * kMaxLobeOrder;

glm::vec2 with_signs_of(const glm::vec2& size, const glm::vec2& of) {
    return {of.x < 0 ? -size.x : size.x, of.y < 0 ? -size.y : size.y};
}

/// Folds the lower half of an octahedron over the corners of the square.
glm::vec2 folded(const glm::vec2& p) {
    return with_signs_of(1.0f - glm::abs(glm::vec2(p.y, p.x)), p);
}

} // namespace

std::array<std::uint8_t, 2> coded_axis(const glm::vec3& unit) {
    const glm::vec3 sizes = glm::abs(unit);
    glm::vec2 p = glm::vec2(unit) / (sizes.x + sizes.y + sizes.z);
    if (unit.z < 0)
        p = folded(p);
    const glm::vec2 bytes = glm::clamp(glm::round(kMiddle * p + kMiddle), 0.0f, 2 * kMiddle);
    return {static_cast<std::uint8_t>(bytes.x), static_cast<std::uint8_t>(bytes.y)};
}

glm::vec3 decoded_axis(std::uint8_t x, std::uint8_t y) {
    glm::vec2 p = glm::min((glm::vec2(x, y) - kMiddle) / kMiddle, 1.0f);
    const float z = 1 - std::abs(p.x) - std::abs(p.y);
    if (z < 0)
        p = folded(p);
    return glm::normalize(glm::vec3(p, z));
}

Lobe LobeModel::decode(const LobeWord& word) const {
    Lobe lobe{decoded_axis(word[0], word[1]), profiles[word[2]]};
    for (float& gain : lobe.profile)
        gain *= static_cast<float>(word[3]) / 255;
    return lobe;
}

void LobeModel::decode(std::size_t vertex, std::span<Lobe> to) const {
    assert(to.size() >= lobes);
    std::fill(to.begin(), to.end(), Lobe());
    for (std::size_t k = 0; k < lobes; ++k)
        to[k] = decode(words[vertex * lobes + k]);
}

void check_lobes(const LobeModel& model) {
    if (model.order < 2 || model.order > kMaxLobeOrder)
        throw Error("the order of lobes must be in 2.." + std::to_string(kMaxLobeOrder) + ", not " +
                    std::to_string(model.order));
    if (model.lobes < 1 || model.lobes > kMaxLobes)
        throw Error("the number of lobes per vertex must be in 1.." + std::to_string(kMaxLobes) + ", not " +
                    std::to_string(model.lobes));
    if (model.profiles.empty() || model.profiles.size() > kMaxProfiles)
        throw Error("the number of lobe profiles must be in 1.." + std::to_string(kMaxProfiles) + ", not " +
                    std::to_string(model.profiles.size()));
    for (const LobeProfile& profile : model.profiles)
        for (const float gain : profile)
            if (!(std::abs(gain) <= kMaxGain))
                throw Error("a lobe profile contains a number that is not finite or too large");
    for (const LobeWord& word : model.words)
        if (word[2] >= model.profiles.size())
            throw Error("a lobe has profile " + std::to_string(word[2]) + ", but there are only " +
                        std::to_string(model.profiles.size()));
}

glm::mat3 axis_rotation(const glm::mat3& m) {
    const glm::mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::dot(m[0], cofactors[0]) < 0 ? -cofactors : cofactors;
}

glm::vec3 rotated_axis(const glm::vec3& axis, const glm::mat3& rotation) {
    const glm::vec3 rotated = rotation * axis;
    const float length = glm::length(rotated);
    return length > 0 && std::isfinite(length) ? rotated / length : axis;
}

void lobe_transfer(std::span<const Lobe> lobes, int order, std::span<float> transfer) {
    assert(order <= kMaxLobeOrder && transfer.size() == static_cast<std::size_t>(order * order));
    std::fill(transfer.begin(), transfer.end(), 0.0f);
    std::array<float, kMaxCoefficients> basis{};
    for (const Lobe& lobe : lobes) {
        evaluate_sh(order, lobe.axis, std::span(basis).first(transfer.size()));
        for (int l = 0, i = 0; l < order; ++l)
            for (int m = -l; m <= l; ++m, ++i)
                transfer[static_cast<std::size_t>(i)] +=
                    lobe.profile[static_cast<std::size_t>(l)] * basis[static_cast<std::size_t>(i)];
    }
}

glm::vec3 lobe_radiance(std::span<const Lobe> lobes, std::span<const glm::vec3> light, int light_order) {
    const int order = std::min(light_order, kMaxLobeOrder);
    std::array<float, kMaxCoefficients> transfer{};
    const auto used = std::span(transfer).first(static_cast<std::size_t>(order * order));
    lobe_transfer(lobes, order, used);
    glm::vec3 sum(0);
    for (std::size_t i = 0; i < used.size(); ++i)
        sum += used[i] * light[i];
    return glm::max(sum, glm::vec3(0));
}

} // namespace prt

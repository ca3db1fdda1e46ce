// Computes the light of partially shadowed receivers from the cells of an image, and from coefficients.
#include "runtime/fit/shadowed_light.h"

#include "prt/core/sh.h"
#include "runtime/fit/across.h"
#include "runtime/fit/gauss_points.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;

constexpr int kReceivers = 1024;

/// Returns direction `i` of a spherical Fibonacci lattice of `count`.
glm::dvec3 lattice_direction(int i, int count) {
    const double z = 1 - (2.0 * i + 1) / count, rotation = 2 * pi * i * (std::numbers::phi - 1);
    const double across = std::sqrt(1 - z * z);
    return {across * std::cos(rotation), z, across * std::sin(rotation)};
}

/// Returns sample directions of a sun's disc; their number resolves half-shadows to 3 %.
std::vector<glm::dvec3> disc_directions(const Sun& sun) {
    constexpr int kDirections = 32;
    const glm::dvec3 axis(sun.towards);
    const Across across(axis);
    std::vector<glm::dvec3> directions;
    for (int i = 0; i < kDirections; ++i) {
        const double angle = sun.half_angle * std::sqrt((i + 0.5) / kDirections),
                     rotation = 2 * pi * i * (std::numbers::phi - 1);
        directions.push_back(std::cos(angle) * axis + std::sin(angle) * (std::cos(rotation) * across.x +
                                                                         std::sin(rotation) * across.y));
    }
    return directions;
}

double square(const glm::dvec3& v) {
    return glm::dot(v, v);
}

} // namespace

double ShadowedLight::Receiver::factor(const glm::dvec3& w) const {
    return glm::dot(side, w) > 0 ? std::max(0.0, glm::dot(normal, w)) / pi : 0;
}

std::vector<ShadowedLight::Receiver> ShadowedLight::receivers() {
    // 617 and the number of receivers are coprime: normals and sides traverse the same lattice in unrelated
    // orders.
    std::vector<Receiver> all;
    for (int i = 0; i < kReceivers; ++i) {
        const Receiver receiver{lattice_direction(i, kReceivers),
                                lattice_direction(i * 617 % kReceivers, kReceivers)};
        // A receiver that sees the full hemisphere, or almost nothing, has no shadow boundary.
        if (std::abs(glm::dot(receiver.normal, receiver.side)) < 0.9)
            all.push_back(receiver);
    }
    return all;
}

/// Projects cosine times half-space. The domain is a slice of the sphere, whose edges meet on the
/// intersection axis of its two planes: the integral is parametrised by the angle to this axis and the
/// rotation about it.
std::vector<double> ShadowedLight::transfer(const Receiver& receiver) const {
    const glm::dvec3 axis = glm::normalize(glm::cross(receiver.normal, receiver.side)),
                     across = glm::cross(axis, receiver.normal);
    const double first =
        std::acos(std::clamp(glm::dot(receiver.normal, receiver.side), -1.0, 1.0)) - 0.5 * pi;
    std::array<double, kMaxOrder * kMaxOrder> basis{};
    std::vector<double> sum(static_cast<std::size_t>(coefficient_count(order_)), 0.0);
    constexpr int kPieces = 6; // intervals of three points; error 1e-5 at order 10
    for (int i = 0; i < kPieces; ++i)
        for (const GaussPoint& theta : gauss_points(pi * i / kPieces, pi * (i + 1) / kPieces))
            for (int j = 0; j < kPieces; ++j) {
                const double width = (0.5 * pi - first) / kPieces;
                for (const GaussPoint& rotation : gauss_points(first + width * j, first + width * (j + 1))) {
                    const double sine = std::sin(theta.at), cosine = std::cos(rotation.at);
                    const glm::dvec3 w = std::cos(theta.at) * axis +
                                         sine * (cosine * receiver.normal + std::sin(rotation.at) * across);
                    evaluate_sh(order_, w, std::span<double>(basis));
                    const double weight = theta.weight * rotation.weight * sine * sine * cosine / pi;
                    for (std::size_t k = 0; k < sum.size(); ++k)
                        sum[k] += weight * basis[k];
                }
            }
    return sum;
}

ShadowedLight::ShadowedLight(const SkyMap& whole, int order) : order_(order), receivers_(receivers()) {
    const std::vector<SkyCell> cells = whole.cells();
    for (const Receiver& receiver : receivers_) {
        glm::dvec3 light(0);
        for (const SkyCell& cell : cells)
            light += receiver.factor(cell.direction) * cell.flux;
        light_.push_back(light);
        square_ += square(light);
        transfer_.push_back(transfer(receiver));
    }
}

double ShadowedLight::error(const Light& remainder, const std::vector<Sun>& suns) const {
    std::vector<std::vector<glm::dvec3>> discs;
    for (const Sun& sun : suns)
        discs.push_back(disc_directions(sun));
    double sum = 0;
    for (std::size_t r = 0; r < receivers_.size(); ++r) {
        glm::dvec3 lack = light_[r];
        for (std::size_t i = 0; i < transfer_[r].size(); ++i)
            lack -= transfer_[r][i] * glm::dvec3(remainder.coefficients[i]);
        for (std::size_t s = 0; s < suns.size(); ++s)
            for (const glm::dvec3& w : discs[s])
                lack -= receivers_[r].factor(w) / static_cast<double>(discs[s].size()) *
                        glm::dvec3(suns[s].irradiance);
        sum += square(lack);
    }
    return square_ > 0 ? std::sqrt(sum / square_) : 0;
}

} // namespace prt

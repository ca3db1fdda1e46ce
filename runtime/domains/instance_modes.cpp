// Modes of the lighting of instances (docs/math.md, section 22), and transfer under each mode.

#include "prt/core/instances.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/sh/gauss_legendre.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/support/vector_lanes.h"
#include "runtime/domains/instance_lamps.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

std::size_t coefficients_of(int order) {
    return static_cast<std::size_t>(coefficient_count(order));
}

/// Computes the weighted sum of the modes of a receiver, [modes][size].
PRT_TWO_CLONES
void sum_modes(const std::array<float, kPassingModes>& factors, const float* modes, std::size_t size,
               float* sums) {
    std::size_t i = 0;
    for (; i + kNarrow <= size; i += kNarrow) {
        Floats<kNarrow>::Value sum = {};
        for (std::size_t m = 0; m < kPassingModes; ++m)
            sum += factors[m] * floats_at<kNarrow>(modes + m * size + i);
        *reinterpret_cast<Floats<kNarrow>::InMemory*>(sums + i) = sum;
    }
    for (; i < size; ++i) {
        sums[i] = 0;
        for (std::size_t m = 0; m < kPassingModes; ++m)
            sums[i] += factors[m] * modes[m * size + i];
    }
}

/// Returns two unit vectors orthogonal to `up` and to each other.
std::array<glm::dvec3, 2> level_axes(const glm::dvec3& up) {
    const glm::dvec3 other = std::abs(up.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 across = glm::normalize(glm::cross(up, other));
    return {across, glm::cross(across, up)};
}

/// Calls `take(direction, solid angle)` for the nodes of a quadrature over the hemisphere about `up`. It is
/// exact for polynomials of degree 2 order + 1; modes need 2 order. After integration over the azimuth the
/// integrand is a polynomial in the height.
template <class Take>
void over_upper_half(int order, const glm::dvec3& up, const Take& take) {
    const GaussLegendre heights(order + 1);
    const int around = 2 * order + 2;
    const auto [across, along] = level_axes(up);
    for (std::size_t i = 0; i < heights.nodes.size(); ++i) {
        const double height = 0.5 * (heights.nodes[i] + 1), radius = std::sqrt(1 - height * height);
        for (int j = 0; j < around; ++j) {
            const double angle = 2 * std::numbers::pi * j / around;
            take(height * up + radius * (std::cos(angle) * across + std::sin(angle) * along),
                 0.5 * heights.weights[i] * 2 * std::numbers::pi / around);
        }
    }
}

/// Scale from a basis function to the function of a mode, whose mean square is 1.
const double kModeScale = std::sqrt(4 * std::numbers::pi);

using Responses = std::array<float, kInstanceLampFunctions>;

/// Returns the response of a single-channel vector to the radiance √(4π)·Y_i.
Responses response(std::span<const float> vector) {
    Responses answers{};
    for (std::size_t k = 0; k < std::min(answers.size(), vector.size()); ++k)
        answers[k] = static_cast<float>(kModeScale) * vector[k];
    return answers;
}

TransferLayout without_lamps(TransferLayout layout) {
    layout.terms.resize(layout.distant_terms().size());
    return layout;
}

} // namespace

InstanceModes::InstanceModes(int order, const glm::dvec3& up) : order_(order) {
    check_order(order);
    const std::size_t count = coefficients_of(order);
    std::vector<double> sums(kPassingModes * count * count), basis(count);
    over_upper_half(order, up, [&](const glm::dvec3& direction, double weight) {
        evaluate_sh(order, direction, basis);
        std::array<double, kPassingModes - 1> functions;
        evaluate_sh(kPassingOrder, direction, functions);
        for (std::size_t m = 0; m < functions.size(); ++m)
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t j = 0; j < count; ++j)
                    sums[(m * count + i) * count + j] +=
                        weight * kModeScale * functions[m] * basis[i] * basis[j];
    });
    double* const below = &sums[(kPassingModes - 1) * count * count];
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count; ++j)
            below[i * count + j] = (i == j ? 1.0 : 0.0) - sums[i * count + j];
    matrices_.assign(sums.begin(), sums.end());
    clamped_cosine_lobe(order, up, basis);
    level_.assign(basis.begin(), basis.end());
}

std::span<const float> InstanceModes::matrix(std::size_t mode) const {
    const std::size_t size = level_.size() * level_.size();
    return std::span(matrices_).subspan(mode * size, size);
}

std::array<Lighting, kInstanceModes> InstanceModes::lightings(const Lighting& lighting) const {
    if (lighting.sky.order < order_ || (lighting.suns && lighting.suns->order < order_))
        throw Error("the order of the lighting is lower than the order of the transfer");
    const std::size_t count = level_.size();
    const auto through = [&](std::size_t mode, const Light& light) {
        Light result{order_, std::vector<glm::vec3>(count, glm::vec3(0))};
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < count; ++j)
                result.coefficients[i] += matrix(mode)[i * count + j] * light.coefficients[j];
        return result;
    };
    std::array<Lighting, kInstanceModes> result;
    for (std::size_t m = 0; m < kPassingModes; ++m) {
        result[m].sky = through(m, lighting.sky);
        if (lighting.suns)
            result[m].suns = through(m, *lighting.suns);
    }
    glm::vec3 on_level(0);
    for (std::size_t i = 0; i < count; ++i)
        on_level += level_[i] * (lighting.sky.coefficients[i] +
                                 (lighting.suns ? lighting.suns->coefficients[i] : glm::vec3(0)));
    for (std::size_t k = 0; k < kAddedModes; ++k) {
        Light& light = result[kPassingModes + k].sky;
        light = {order_, std::vector<glm::vec3>(count, glm::vec3(0))};
        if (k < count)
            light.coefficients[k] = static_cast<float>(kModeScale) * on_level;
    }
    return result;
}

SharedTransfer::SharedTransfer(const Transfer& transfer, const glm::dvec3& up, int threads)
    : layout_(without_lamps(transfer.layout)), modes_(transfer.layout.order, up) {
    if (layout_.terms.empty() || layout_.outputs != 1)
        throw Error("instances that share transfer need transfer of distant light");
    const std::size_t dimension = layout_.dimension(), count = modes_.level().size(),
                      receivers = transfer.receivers();
    passing_.resize(receivers * kPassingModes * dimension);
    responses_.resize(receivers);
    parallel_for(receivers, 64, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t r = begin; r < end; ++r) {
            const std::span<const float> from = transfer.vector(r);
            float* to = &passing_[r * kPassingModes * dimension];
            for (std::size_t m = 0; m < kPassingModes; ++m)
                for (std::size_t first = 0; first < dimension; first += count)
                    for (std::size_t i = 0; i < count; ++i, ++to)
                        for (std::size_t j = 0; j < count; ++j)
                            *to += modes_.matrix(m)[i * count + j] * from[first + j];
            responses_[r] = {};
            std::size_t first = 0;
            for (const TransferTerm& term : layout_.terms)
                for (int c = 0; c < term.channels; ++c, first += count) {
                    const Responses answers = response(from.subspan(first, count));
                    for (std::size_t k = 0; k < answers.size(); ++k)
                        for (int color = term.channels == 1 ? 0 : c; color <= (term.channels == 1 ? 2 : c);
                             ++color)
                            responses_[r][k][color] += answers[k];
                }
        }
    });
}

void SharedTransfer::sum(std::size_t receiver, std::span<const glm::vec3> factors,
                         std::span<float> vector) const {
    std::array<float, kPassingModes> passing;
    for (std::size_t m = 0; m < kPassingModes; ++m)
        passing[m] = factors[m].x;
    sum_modes(passing, &passing_[receiver * kPassingModes * vector.size()], vector.size(), vector.data());
    const TransferTerm& last = layout_.terms.back();
    if (last.kind == TermKind::direct)
        return;
    const std::size_t count = level().size(), channels = static_cast<std::size_t>(last.channels);
    for (std::size_t c = 0; c < channels; ++c) {
        float added = 0;
        for (std::size_t k = 0; k < kAddedModes; ++k)
            added += factors[kPassingModes + k][static_cast<int>(c)] *
                     responses_[receiver][k][static_cast<int>(c)];
        float* const to = &vector[vector.size() - (channels - c) * count];
        for (std::size_t i = 0; i < count; ++i)
            to[i] += added * level()[i];
    }
}

glm::vec3 SharedTransfer::lamp_radiance(std::size_t receiver, const InstanceLampLight& light,
                                        const glm::vec3& position) const {
    glm::vec3 radiance(0);
    for (std::size_t i = 0; i < kInstanceLampFunctions; ++i)
        for (int c = 0; c < 3; ++c)
            radiance[c] += responses_[receiver][i][c] *
                           glm::dot(light.functions[i][static_cast<std::size_t>(c)], glm::vec4(position, 1));
    return radiance;
}

void expand_instance(const SharedTransfer& shared, const TransferLayout& layout,
                     const PlacedInstance& instance, std::span<const glm::vec3> positions,
                     std::span<float> vectors) {
    check_instance_lamps(layout, instance);
    const std::size_t dimension = layout.dimension(), distant = shared.layout().dimension(),
                      count = shared.level().size();
    const InstanceFactors factors = in_axes_of_mesh(instance.factors, instance.rotation);
    const ShRotation rotation(shared.layout().order, instance.rotation);
    for (std::size_t r = 0; r < shared.receivers(); ++r) {
        const std::span<float> vector = vectors.subspan(r * dimension, dimension);
        const glm::vec3 position = instance.box.position_of(positions[r]);
        shared.sum(r, mode_factors(factors, position), vector.first(distant));
        for (std::size_t first = 0; first < distant; first += count)
            rotation.apply(vector.subspan(first, count), vector.subspan(first, count));
        float* to = vector.data() + distant;
        for (std::size_t l = 0; l < instance.lamps.size(); ++l) {
            const glm::vec3 radiance = shared.lamp_radiance(r, instance.lamps[l], position);
            if (layout.lamp_terms()[l].channels == 1)
                *to++ = (radiance.r + radiance.g + radiance.b) / 3;
            else
                to = std::copy_n(&radiance[0], 3, to);
        }
    }
}

} // namespace prt

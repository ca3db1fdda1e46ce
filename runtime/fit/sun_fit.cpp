// Fits cones of light to the higher bands of a lighting, from its peaks on, by least squares (Ceres).
#include "prt/sun_fit.h"

#include "prt/color.h"
#include "prt/sh.h"
#include "prt/support/error.h"

#include <ceres/ceres.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

namespace prt {

namespace detail {
template <int N>
struct ScalarOf<ceres::Jet<double, N>> {
    using type = double;
};
} // namespace detail

namespace {

using std::numbers::pi;

constexpr int kOrder = kMaxOrder;
constexpr int kFirstBand = 4; ///< what a smooth sky does not have
constexpr std::size_t kCount = static_cast<std::size_t>(coefficient_count(kOrder));
constexpr std::size_t kFirst = static_cast<std::size_t>(coefficient_count(kFirstBand));
constexpr std::size_t kParameters = 7; ///< direction (any length), cosine of the half angle, irradiance

using Colors = std::array<glm::dvec3, kCount>;

/// Factors of a cone of irradiance 1 over Y_lm of its axis: 2 P_l'(t) / (l (l+1)) with the cosine t of the
/// half angle, and 2 / (1 + t) for l = 0: eq. 14, which is eq. 12 without the differences that cancel for
/// narrow cones.
template <class T>
std::array<T, kOrder> cone_factors(const T& t) {
    std::array<T, kOrder> factors;
    factors[0] = 2.0 / (1.0 + t);
    T legendre_before(1.0), legendre = t, slope(1.0), slope_before(0.0);
    for (int l = 1; l < kOrder; ++l) {
        factors[static_cast<std::size_t>(l)] = 2.0 * slope / (l * (l + 1.0));
        const T next =
            ((2.0 * l + 1.0) * t * legendre - static_cast<double>(l) * legendre_before) / (l + 1.0);
        const T next_slope = slope_before + (2.0 * l + 1.0) * legendre;
        legendre_before = legendre;
        legendre = next;
        slope_before = slope;
        slope = next_slope;
    }
    return factors;
}

/// What the lights lack of the target's bands from kFirstBand on.
struct Residual {
    const Colors& target;
    std::size_t lights;

    template <class T>
    bool operator()(T const* const* parameters, T* residuals) const {
        for (std::size_t i = kFirst; i < kCount; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                residuals[3 * (i - kFirst) + c] = T(-target[i][static_cast<int>(c)]);
        for (std::size_t k = 0; k < lights; ++k) {
            const T* p = parameters[k];
            const T length = ceres::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
            std::array<T, kCount> basis;
            sh_basis<kOrder>(T(p[0] / length), T(p[1] / length), T(p[2] / length), basis.data());
            const std::array<T, kOrder> factors = cone_factors(p[3]);
            for (int l = kFirstBand; l < kOrder; ++l)
                for (int m = -l; m <= l; ++m) {
                    const auto i = static_cast<std::size_t>(sh_index(l, m));
                    const T value = factors[static_cast<std::size_t>(l)] * basis[i];
                    for (std::size_t c = 0; c < 3; ++c)
                        residuals[3 * (i - kFirst) + c] += value * p[4 + c];
                }
        }
        return true;
    }
};

/// The color of the bands from kFirstBand on in direction `w`, over what a directional light of irradiance 1
/// would have there.
glm::dvec3 peak_irradiance(const Colors& left, const glm::dvec3& w) {
    std::array<double, kCount> basis{};
    evaluate_sh(kOrder, w, std::span<double>(basis));
    glm::dvec3 value(0);
    for (std::size_t i = kFirst; i < kCount; ++i)
        value += basis[i] * left[i];
    return value * (4 * pi / static_cast<double>(kCount - kFirst));
}

/// The direction where `left` has its highest peak: on a grid of two degrees, a tenth of the peaks' width.
glm::dvec3 highest_peak(const Colors& left) {
    constexpr int kRows = 90;
    glm::dvec3 best(0, 1, 0);
    double highest = 0;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < 2 * kRows; ++column) {
            const double theta = pi * (row + 0.5) / kRows, phi = pi * (column + 0.5) / kRows;
            const glm::dvec3 w(std::sin(theta) * std::sin(phi), std::cos(theta),
                               std::sin(theta) * std::cos(phi));
            const double value = luminance(peak_irradiance(left, w));
            if (value > highest) {
                highest = value;
                best = w;
            }
        }
    return best;
}

using Parameters = std::array<double, kParameters>;

FittedLight light_of(const Parameters& p) {
    FittedLight light;
    light.towards = glm::vec3(glm::normalize(glm::dvec3(p[0], p[1], p[2])));
    light.half_angle = std::acos(std::clamp(p[3], -1.0, 1.0));
    light.irradiance = {static_cast<float>(p[4]), static_cast<float>(p[5]), static_cast<float>(p[6])};
    return light;
}

void refine(const Colors& target, std::vector<Parameters>& lights) {
    ceres::Problem problem;
    auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<Residual, 7>>(
        new Residual{target, lights.size()});
    std::vector<double*> blocks;
    for (Parameters& p : lights) {
        cost->AddParameterBlock(static_cast<int>(kParameters));
        blocks.push_back(p.data());
    }
    cost->SetNumResiduals(static_cast<int>(3 * (kCount - kFirst)));
    problem.AddResidualBlock(cost.release(), nullptr, blocks);
    for (double* p : blocks) {
        problem.SetParameterLowerBound(p, 3, std::cos(kWidestFittedLight));
        problem.SetParameterUpperBound(p, 3, 1);
        for (int c = 4; c < 7; ++c)
            problem.SetParameterLowerBound(p, c, 0);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
}

Colors colors_of(const Light& light) {
    Colors colors;
    for (std::size_t i = 0; i < kCount; ++i)
        colors[i] = glm::dvec3(light.coefficients[i]);
    return colors;
}

} // namespace

Light as_light(const FittedLight& light, int order) {
    Light result = directional_light(order, light.towards, light.irradiance);
    const auto factors = cone_factors(std::cos(light.half_angle));
    for (int l = 0; l < order; ++l)
        for (int m = -l; m <= l; ++m)
            result.coefficients[static_cast<std::size_t>(sh_index(l, m))] *=
                static_cast<float>(factors[static_cast<std::size_t>(l)]);
    return result;
}

SunFit fit_suns(const Light& environment, int order, int count) {
    check_order(order);
    if (count < 1)
        throw Error("at least one light is to be fitted, not " + std::to_string(count));
    const Light whole = truncated(environment, kOrder); // which refuses what is not finite
    const Colors target = colors_of(whole);
    std::vector<Parameters> found;
    Colors left = target;
    for (int k = 0; k < count; ++k) {
        const glm::dvec3 w = highest_peak(left), e = glm::max(peak_irradiance(left, w), glm::dvec3(0));
        if (!(luminance(e) > 0))
            break;
        found.push_back({w.x, w.y, w.z, std::cos(0.02), e.x, e.y, e.z});
        refine(target, found);
        left = target;
        for (const Parameters& p : found) {
            const Colors of_light = colors_of(as_light(light_of(p), kOrder));
            for (std::size_t i = 0; i < kCount; ++i)
                left[i] -= of_light[i];
        }
    }
    SunFit fit;
    for (const Parameters& p : found)
        fit.lights.push_back(light_of(p));
    std::sort(fit.lights.begin(), fit.lights.end(), [](const FittedLight& a, const FittedLight& b) {
        return luminance(glm::dvec3(a.irradiance)) > luminance(glm::dvec3(b.irradiance));
    });
    fit.remainder = truncated(whole, order);
    const double all = luminance(target[0]);
    for (FittedLight& light : fit.lights) {
        const Light own = as_light(light, order);
        light.energy_share = all > 0 ? luminance(glm::dvec3(own.coefficients[0])) / all : 0;
        fit.remainder_share -= light.energy_share;
        for (std::size_t i = 0; i < fit.remainder.coefficients.size(); ++i)
            fit.remainder.coefficients[i] -= own.coefficients[i];
    }
    return fit;
}

} // namespace prt

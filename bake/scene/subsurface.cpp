// The dipole and the measured media of H. W. Jensen, S. R. Marschner, M. Levoy, P. Hanrahan, "A Practical
// Model for Subsurface Light Transport", SIGGRAPH 2001.

#include "prt/bake/bake_options.h"

#include "runtime/load/light_passing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

constexpr double kPerMillimetre = 1000;

constexpr NamedMedium named(std::string_view name, const glm::dvec3& scattering, const glm::dvec3& absorption,
                            double ior) {
    return {name, {scattering * kPerMillimetre, absorption * kPerMillimetre, ior}};
}

const std::array<NamedMedium, 12> kMeasured = {
    named("apple", {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}, 1.3),
    named("chicken1", {0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}, 1.3),
    named("chicken2", {0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}, 1.3),
    named("cream", {7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}, 1.3),
    named("ketchup", {0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}, 1.3),
    named("marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}, 1.5),
    named("potato", {0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}, 1.3),
    named("skim-milk", {0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}, 1.3),
    named("skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}, 1.3),
    named("skin2", {1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}, 1.3),
    named("spectralon", {11.6, 20.4, 14.9}, {0.00, 0.00, 0.00}, 1.3),
    named("whole-milk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}, 1.3)};

/// Returns (1 + Fdr)/(1 - Fdr): the effect of the change of the refractive index at the surface on the
/// diffuse flux.
double boundary_term(double ior) {
    const double fdr = -1.440 / (ior * ior) + 0.710 / ior + 0.668 + 0.0636 * ior;
    return (1 + fdr) / (1 - fdr);
}

/// Diffuse albedo of a half space as a function of only the reduced albedo (Jensen and Buhler 2002).
double diffuse_albedo(double reduced, double ior) {
    const double depth = std::sqrt(3 * (1 - reduced));
    return reduced / 2 * (1 + std::exp(-4.0 / 3 * boundary_term(ior) * depth)) * std::exp(-depth);
}

} // namespace

std::span<const NamedMedium> measured_media() {
    return kMeasured;
}

Dipole::Dipole(double scattering, double absorption, double ior) {
    const double extinction = scattering + absorption;
    albedo_ = scattering / extinction;
    falloff_ = std::sqrt(3 * absorption * extinction);
    real_depth_ = 1 / extinction;
    virtual_depth_ = real_depth_ * (1 + 4.0 / 3 * boundary_term(ior));
    total_ = albedo_ / 2 * (std::exp(-falloff_ * real_depth_) + std::exp(-falloff_ * virtual_depth_));
}

double Dipole::reflectance(double distance) const {
    const auto source = [&](double depth) {
        const double d = std::hypot(distance, depth);
        return depth * (1 + falloff_ * d) * std::exp(-falloff_ * d) / (d * d * d);
    };
    return albedo_ / (4 * std::numbers::pi) * (source(real_depth_) + source(virtual_depth_));
}

double Dipole::inside(double radius) const {
    // d/dr of -exp(-s d)/d, with d² = r² + z², is r (1 + s d) exp(-s d)/d³.
    const auto source = [&](double depth) {
        const double d = std::hypot(radius, depth);
        return std::exp(-falloff_ * depth) - (std::isinf(d) ? 0 : depth * std::exp(-falloff_ * d) / d);
    };
    return albedo_ / 2 * (source(real_depth_) + source(virtual_depth_));
}

double reduced_albedo(double reflectance, double ior) {
    double low = 0, high = 1; // diffuse_albedo increases from 0 to 1
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (diffuse_albedo(middle, ior) < reflectance ? low : high) = middle;
    }
    return (low + high) / 2;
}

std::optional<Medium> medium_of(const Material& material) {
    if (!has_medium(material))
        return std::nullopt;
    const MaterialVolume& volume = material.volume;
    Medium medium;
    medium.ior = 1.5; // glTF's default
    for (int c = 0; c < 3; ++c) {
        const double left = std::clamp(static_cast<double>(volume.attenuation_color[c]), 1e-4, 1 - 1e-4);
        const double extinction = -std::log(left) / static_cast<double>(volume.attenuation_distance);
        const double reflectance = std::clamp(static_cast<double>(material.base_color[c]), 1e-3, 1 - 1e-4);
        const double albedo = reduced_albedo(reflectance, medium.ior);
        medium.scattering[c] = albedo * extinction;
        medium.absorption[c] = (1 - albedo) * extinction;
    }
    return medium;
}

} // namespace prt

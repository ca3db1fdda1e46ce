#pragma once

// Subsurface scattering by the multiple-scattering dipole: H. W. Jensen, S. Marschner, M. Levoy, P. Hanrahan,
// "A Practical Model for Subsurface Light Transport", SIGGRAPH 2001.

#include "prt/scene.h"

#include <glm/vec3.hpp>

#include <optional>
#include <span>
#include <string_view>

namespace prt {

/// A homogeneous medium that scatters light. Vectors have the components red, green and blue, linear Rec.
/// 709.
struct Medium {
    glm::dvec3 scattering{0}; ///< reduced scattering coefficient sigma_s', 1/m
    glm::dvec3 absorption{0}; ///< absorption coefficient sigma_a, 1/m
    double ior = 1.3;         ///< index of refraction relative to air
};

/// Limits that a bake checks, in 1 / unit of the scene. The densest measured medium has sigma_s' = 2e4 / m.
inline constexpr double kMinScattering = 1e-9, ///< minimum of sigma_s'; the minimum of sigma_a is 0
    kMaxCoefficient = 1e9;                     ///< maximum of sigma_s' and of sigma_a

/// A measured medium of Jensen et al. 2001, figure 5.
struct NamedMedium {
    std::string_view name; ///< lower case: "marble", "skin1", "whole-milk" and others
    Medium medium;         ///< coefficients in 1/m
};
/// Returns the 12 measured media, sorted by name. The span is valid until the program ends.
std::span<const NamedMedium> measured_media();

/// Returns the medium of a glTF material. The material must have KHR_materials_volume with a thickness and a
/// finite attenuation distance, and a factor of KHR_materials_diffuse_transmission greater than 0; otherwise
/// returns no value. The attenuation defines sigma_s' + sigma_a. The base color factor (without texture) is
/// the diffuse reflectance of a thick slab and defines sigma_s' / (sigma_s' + sigma_a). The index of
/// refraction is 1.5.
std::optional<Medium> medium_of(const Material& material);

/// Diffuse reflection of a half space that is filled with a medium, for one color channel. Light that enters
/// at one point of the plane surface leaves at other points.
class Dipole {
public:
    /// `scattering`: sigma_s' in 1/m, greater than 0. `absorption`: sigma_a in 1/m, at least 0. `ior`: index
    /// of refraction relative to air, at least 1. The constructor does not check these ranges.
    Dipole(double scattering, double absorption, double ior);

    /// Returns Rd, the fraction of the entering power that leaves per area at `distance` metres from the
    /// point of entry, in 1/m² (eq. 4 of the paper).
    double reflectance(double distance) const;
    /// Returns the fraction of the entering power that leaves within `radius` metres of the point of entry,
    /// 0..1: the integral of `reflectance` over this disc. For an infinite radius it equals `total`.
    double inside(double radius) const;
    /// Returns the diffuse albedo, 0..1: the fraction of the entering power that leaves anywhere.
    double total() const { return total_; }
    /// Returns the effective transport coefficient sigma_tr in 1/m; 0 without absorption. At a large distance
    /// r, `reflectance` decreases like exp(-sigma_tr r).
    double falloff() const { return falloff_; }
    /// Returns the mean free path 1 / (sigma_s' + sigma_a) in metres: the depth below the surface at which
    /// the model puts its light source. `reflectance` varies little over shorter distances.
    double depth() const { return real_depth_; }

private:
    double albedo_, falloff_, real_depth_, virtual_depth_, total_;
};

/// Returns the reduced albedo sigma_s' / (sigma_s' + sigma_a), 0..1, of the medium that reflects the fraction
/// `reflectance` (0..1) of uniform light diffusely. `ior`: index of refraction of the medium.
double reduced_albedo(double reflectance, double ior);

} // namespace prt

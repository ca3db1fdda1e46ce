#pragma once

// Subsurface scattering by the multiple-scattering dipole: H. W. Jensen, S. Marschner, M. Levoy, P. Hanrahan,
// "A Practical Model for Subsurface Light Transport", SIGGRAPH 2001.

#include "prt/scene.h"

#include <glm/vec3.hpp>

#include <optional>
#include <span>
#include <string_view>

namespace prt {

/// A homogeneous medium, with coefficients for red, green and blue.
struct Medium {
    glm::dvec3 scattering{0}; ///< reduced scattering coefficient sigma_s', 1/m
    glm::dvec3 absorption{0}; ///< sigma_a, 1/m
    double ior = 1.3;         ///< index of refraction
};

/// Limits for the coefficients of a medium, in 1 / unit of the scene: scattering is between both, absorption
/// between 0 and the maximum. The densest measured medium has 2e4.
inline constexpr double kMinScattering = 1e-9, kMaxCoefficient = 1e9;

/// A measured medium of Jensen et al. 2001, figure 5: "marble", "skin1", "whole-milk" and others.
struct NamedMedium {
    std::string_view name;
    Medium medium;
};
/// Returns the measured media.
std::span<const NamedMedium> measured_media();

/// Returns the medium of a glTF material: KHR_materials_volume with a thickness and an attenuation, on a
/// surface that transmits diffuse light (KHR_materials_diffuse_transmission). The attenuation is sigma_t'.
/// The base color is the reflectance of a thick slab, which determines the albedo of the dipole. Returns no
/// value if the material has no such medium.
std::optional<Medium> medium_of(const Material& material);

/// The dipole for one color, on the surface of a half space.
class Dipole {
public:
    /// Coefficients in 1/m.
    Dipole(double scattering, double absorption, double ior);

    /// Returns the diffuse reflectance Rd at `distance` metres from the point where the light enters, 1/m²
    /// (eq. 4 of the paper).
    double reflectance(double distance) const;
    /// Returns the integral of Rd over a disc of radius `radius` metres. For an infinite radius it is the
    /// diffuse albedo.
    double inside(double radius) const;
    /// Integral of Rd over the plane: the diffuse albedo.
    double total() const { return total_; }
    /// Effective transport coefficient sigma_tr, 1/m: at a large distance r, light decreases as exp(-sigma_tr
    /// r).
    double falloff() const { return falloff_; }
    /// Depth of the real source below the surface in metres, one mean free path: Rd is smooth on this scale.
    double depth() const { return real_depth_; }

private:
    double albedo_, falloff_, real_depth_, virtual_depth_, total_;
};

/// Returns the reduced albedo alpha' for which a medium of this index of refraction has the diffuse albedo
/// `reflectance`.
double reduced_albedo(double reflectance, double ior);

} // namespace prt

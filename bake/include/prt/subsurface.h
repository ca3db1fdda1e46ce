#pragma once

// Subsurface scattering by the multiple-scattering dipole: H. W. Jensen, S. Marschner, M. Levoy, P. Hanrahan,
// "A Practical Model for Subsurface Light Transport", SIGGRAPH 2001.

#include "prt/scene.h"

#include <glm/vec3.hpp>

#include <optional>
#include <span>
#include <string_view>

namespace prt {

/// A homogeneous medium, red, green and blue.
struct Medium {
    glm::dvec3 scattering{0}; ///< reduced scattering coefficient sigma_s', 1/m
    glm::dvec3 absorption{0}; ///< sigma_a, 1/m
    double ior = 1.3;         ///< index of refraction
};

/// What the coefficients of a medium may be, in 1/m of the scene's unit: scattering from the least to the
/// most, absorption from 0 to the most. The densest measured one has 2e4.
inline constexpr double kLeastScattering = 1e-9, kMostCoefficient = 1e9;

/// The measured media of Jensen et al. 2001, figure 5: "marble", "skin1", "whole-milk" and so on.
struct NamedMedium {
    std::string_view name;
    Medium medium;
};
std::span<const NamedMedium> measured_media();

/// The medium that glTF gives a material: KHR_materials_volume with a thickness and an attenuation, on a
/// surface that lets diffuse light in (KHR_materials_diffuse_transmission). The attenuation is sigma_t'; the
/// base color is the reflectance of a thick slab, from which the dipole's albedo follows. Nothing where the
/// material has no such inside.
std::optional<Medium> medium_of(const Material& material);

/// The dipole for one color, on the surface of a half space.
class Dipole {
public:
    /// Coefficients in 1/m.
    Dipole(double scattering, double absorption, double ior);

    /// Diffuse reflectance Rd at `distance` metres from where the light enters, 1/m² (eq. 4 of the paper).
    double reflectance(double distance) const;
    /// Integral of Rd over the disc of that radius; over the plane for infinity, which is the diffuse albedo.
    double inside(double radius) const;
    double total() const { return total_; }
    /// sigma_tr, 1/m: far away light falls as exp(-sigma_tr r).
    double falloff() const { return falloff_; }
    /// Of the real source below the surface, a mean free path, in metres: Rd is smooth over this.
    double depth() const { return real_depth_; }

private:
    double albedo_, falloff_, real_depth_, virtual_depth_, total_;
};

/// Reduced albedo alpha' for which a medium of that index of refraction has the diffuse albedo `reflectance`.
double reduced_albedo(double reflectance, double ior);

} // namespace prt

#pragma once

// Spherical harmonics: evaluation, rotation, windows. Conventions: docs/math.md, section 1.
// Everything here is thread-safe and allocates nothing unless it returns a container.

#include "prt/sh_basis.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Throws `Error` unless 1 <= order <= kMaxOrder.
void check_order(int order);

/// Writes the order² basis values in unit direction `direction` to `basis` [order²].
void evaluate_sh(int order, const glm::vec3& direction, std::span<float> basis);
void evaluate_sh(int order, const glm::dvec3& direction, std::span<double> basis);

/// The transfer vector of an open receiver with unit normal `normal`: (1/pi) ∫ max(n·w, 0) Y_i(w) dw, the
/// clamped-cosine lobe (docs/math.md, eq. 6; Ramamoorthi and Hanrahan 2001, eq. 8). `lobe` is [order²].
void clamped_cosine_lobe(int order, const glm::dvec3& normal, std::span<double> lobe);

/// Convolution factor A_l / pi of the clamped cosine for band l, any l >= 0.
double clamped_cosine_factor(int l);

/// Rotates SH vectors: for a function f with coefficients c, the result holds f'(w) = f(R^-1 w). Matrices by
/// the recursion of Ivanic and Ruedenberg (1996, with the corrections of 1998), in double.
class ShRotation {
public:
    /// `rotation` must be a proper rotation matrix.
    ShRotation(int order, const glm::dmat3& rotation);

    int order() const { return order_; }
    /// `in` and `out` are [order²] and must not overlap.
    void apply(std::span<const double> in, std::span<double> out) const;
    /// Rotates `coefficients` [order²] of RGB vectors in place.
    void apply(std::span<glm::vec3> coefficients) const;

private:
    double at(int l, int m, int n) const;
    int order_;
    std::vector<double> blocks_; // band l: (2l+1)² values, rows are m of the result
};

/// Windows that tame ringing (Sloan 2008, "Stupid SH Tricks"). `width` is the band at which the factor
/// reaches 0.
double hann_window(int l, double width);
double lanczos_window(int l, double width);

} // namespace prt

#pragma once

// Spherical harmonics: basis values, the clamped-cosine lobe and windows. prt/sh_vector.h has sums and
// products; prt/sh_rotation.h has rotation. Conventions: docs/math.md, section 1. All functions are
// thread-safe and allocate no memory unless they throw. Only `check_order` checks its argument; the other
// functions require an order in 1..kMaxOrder, unit directions, and output spans that have at least the stated
// length. Stable.

#include "prt/sh_basis.h"
#include "prt/support/glm_layout.h"

#include <glm/vec3.hpp>

#include <span>

namespace prt {

/// Throws `Error` unless 1 <= order <= kMaxOrder; otherwise does nothing.
void check_order(int order);

/// Writes the value of each of the order² basis functions in unit direction `direction` to `basis` [order²],
/// at index l(l+1) + m for band l and degree m. Computes in float.
void evaluate_sh(int order, const glm::vec3& direction, std::span<float> basis);
/// Writes the value of each of the order² basis functions in unit direction `direction` to `basis` [order²],
/// at index l(l+1) + m for band l and degree m. Computes in double.
void evaluate_sh(int order, const glm::dvec3& direction, std::span<double> basis);

/// Writes the basis values in each of the unit directions `directions` to `basis`
/// [order²][directions.size()]: all values of one basis function are contiguous. Evaluates several directions
/// at once, which is several times faster than one call per direction.
void evaluate_sh(int order, std::span<const glm::vec3> directions, std::span<float> basis);

/// Writes the clamped-cosine lobe to `lobe` [order²]: element i is (1/pi) ∫ max(n·w, 0) Y_i(w) dw, with n the
/// unit normal `normal`. The lobe is the transfer vector of an unoccluded receiver of albedo 1
/// (docs/math.md, eq. 8; Ramamoorthi and Hanrahan 2001, eq. 8).
void clamped_cosine_lobe(int order, const glm::dvec3& normal, std::span<double> lobe);

/// Returns A_l / pi for band l, any l >= 0. A_l is the factor by which convolution with the clamped cosine
/// max(cos, 0) multiplies the coefficients of band l. The result is 1 for l = 0, 2/3 for l = 1, 1/4 for l =
/// 2, and 0 for odd l > 1.
double clamped_cosine_factor(int l);

/// Returns the factor of the Hann window for band l >= 0: (1 + cos(pi l / width)) / 2 for l < width, else 0.
/// `width` > 0 is the band, possibly fractional, at which the factor reaches 0; infinity: the factor is 1 for
/// every band.
/// Multiplication of the coefficients of each band with its factor reduces ringing (Sloan 2008, "Stupid SH
/// Tricks").
double hann_window(int l, double width);
/// Returns the factor of the Lanczos window for band l >= 0: 1 for l = 0, sin(t) / t with t = pi l / width
/// for 0 < l < width, else 0. `width` > 0 is the band, possibly fractional, at which the factor reaches 0;
/// infinity: the factor is 1 for every band.
/// Multiplication of the coefficients of each band with its factor reduces ringing (Sloan 2008, "Stupid SH
/// Tricks").
double lanczos_window(int l, double width);

} // namespace prt

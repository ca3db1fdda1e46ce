#pragma once

// Spherical harmonics: evaluation and windows. prt/sh_vector.h: sums and products; prt/sh_rotation.h:
// rotation. Conventions: docs/math.md, section 1. All functions are thread-safe and allocate only for
// containers that they return. Stable.

#include "prt/sh_basis.h"
#include "prt/support/glm_layout.h"

#include <glm/vec3.hpp>

#include <span>

namespace prt {

/// Throws `Error` unless 1 <= order <= kMaxOrder.
void check_order(int order);

/// Writes the order² basis values in unit direction `direction` to `basis` [order²].
void evaluate_sh(int order, const glm::vec3& direction, std::span<float> basis);
void evaluate_sh(int order, const glm::dvec3& direction, std::span<double> basis);

/// Evaluates many directions at once, several times faster than one by one. `basis` is [order²][directions]:
/// all values of one coefficient are contiguous.
void evaluate_sh(int order, std::span<const glm::vec3> directions, std::span<float> basis);

/// Writes the transfer vector of an unoccluded receiver with unit normal `normal` to `lobe` [order²]: (1/pi)
/// ∫ max(n·w, 0) Y_i(w) dw, the clamped-cosine lobe (docs/math.md, eq. 8; Ramamoorthi and Hanrahan 2001, eq.
/// 8).
void clamped_cosine_lobe(int order, const glm::dvec3& normal, std::span<double> lobe);

/// Returns the convolution factor A_l / pi of the clamped cosine for band l, any l >= 0.
double clamped_cosine_factor(int l);

/// Returns the factor of band l of the Hann window, which reduces ringing (Sloan 2008, "Stupid SH Tricks").
/// `width` is the band at which the factor reaches 0.
double hann_window(int l, double width);
/// Returns the factor of band l of the Lanczos window, which reduces ringing (Sloan 2008, "Stupid SH
/// Tricks"). `width` is the band at which the factor reaches 0.
double lanczos_window(int l, double width);

} // namespace prt

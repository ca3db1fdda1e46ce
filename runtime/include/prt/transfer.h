#pragma once

// Raw transfer vectors, as produced by the baker. Stable.

#include "prt/support/glm_layout.h"
#include "prt/transfer_layout.h"

#include <glm/vec3.hpp>

#include <span>
#include <utility>
#include <vector>

namespace prt {

/// Maximum magnitude of a transfer coefficient in files. Valid coefficients are far smaller, even with many
/// bounces. With much larger values, squares and sums of lit values would overflow a float.
inline constexpr float kMaxTransfer = 1e6f;

/// The transfer vectors of a list of receivers: exit radiance of a Lambertian receiver of albedo rho is R_c =
/// rho_c · sum_i T[c][i] L_c[i] (docs/math.md, eq. 7).
struct Transfer {
    TransferLayout layout;
    std::vector<float> vectors; ///< [receivers][layout.dimension()]

    std::size_t dimension() const { return layout.dimension(); }
    std::size_t receivers() const { return dimension() == 0 ? 0 : vectors.size() / dimension(); }
    std::span<const float> vector(std::size_t receiver) const {
        return std::span(vectors).subspan(receiver * dimension(), dimension());
    }
    std::span<float> vector(std::size_t receiver) {
        return std::span(vectors).subspan(receiver * dimension(), dimension());
    }
};

/// Returns transfer of `receivers` receivers with all coefficients 0.
inline Transfer zero_transfer(TransferLayout layout, std::size_t receivers) {
    Transfer transfer{std::move(layout), {}};
    transfer.vectors.resize(receivers * transfer.dimension());
    return transfer;
}
/// Returns transfer with a single term and all coefficients 0.
inline Transfer zero_transfer(int order, int channels, std::size_t receivers) {
    return zero_transfer(layout_of_one(order, channels), receivers);
}

/// Returns the exit radiance for albedo 1 of one transfer vector [layout.dimension()]: the sum over its
/// terms. `columns` is the result of `light_columns`. The single channel of a grey term is used for all
/// colors.
glm::vec3 exit_radiance(std::span<const float> transfer, const TransferLayout& layout,
                        std::span<const glm::vec3> columns);

/// Computes the exit radiance of every receiver for albedo 1, [receivers]. Throws `Error` if the lighting has
/// too few bands.
std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Lighting& lighting, int threads = 0);
/// Computes the exit radiance of every receiver for albedo 1, [receivers], under the sky `light` without
/// separate suns; lamps have the strength 1.
std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Light& light, int threads = 0);

/// Returns the layout with all terms of distant light merged into one, which has three channels if any of
/// them has color. Sky and suns then light the same term. Lamps are unchanged.
TransferLayout as_combined(const TransferLayout& layout);
/// Returns transfer with all terms of distant light merged into one.
Transfer as_combined(const Transfer& transfer, int threads = 0);
/// Returns one vector [layout.dimension()] with all terms of distant light merged into one.
std::vector<float> as_combined(std::span<const float> transfer, const TransferLayout& layout);

/// Returns the area-weighted mean of T_0 / Y_00, summed over all terms except lamps and averaged over the
/// channels: the fraction of a uniform sky's light that arrives.
double mean_visibility(const Transfer& transfer, std::span<const float> areas);

} // namespace prt

#pragma once

// Raw transfer vectors, as produced by the baker. Stable.

#include "prt/support/glm_layout.h"
#include "prt/transfer_layout.h"

#include <glm/vec3.hpp>

#include <span>
#include <utility>
#include <vector>

namespace prt {

/// Maximum magnitude of a transfer coefficient in files. Light after many bounces adds up to a small number;
/// for much larger values the squares and sums of lit values would overflow a float.
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

inline Transfer zero_transfer(TransferLayout layout, std::size_t receivers) {
    Transfer transfer{std::move(layout), {}};
    transfer.vectors.resize(receivers * transfer.dimension());
    return transfer;
}
/// Returns zero transfer with a single term.
inline Transfer zero_transfer(int order, int channels, std::size_t receivers) {
    return zero_transfer(layout_of_one(order, channels), receivers);
}

/// Returns the sum over all terms of one transfer vector [layout.dimension()], lit by `columns`, the result
/// of `light_columns`. The single channel of a grey term is used for all colors.
glm::vec3 exit_radiance(std::span<const float> transfer, const TransferLayout& layout,
                        std::span<const glm::vec3> columns);

/// Computes the exit radiance of every receiver for albedo 1, [receivers]. Throws `Error` if the lighting has
/// too few bands.
std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Lighting& lighting, int threads = 0);
/// Computes exit radiance with all light in one sky, [receivers].
std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Light& light, int threads = 0);

/// Merges all terms of distant light into one, with three channels if any term has color. Sky and suns then
/// light the same term. Lamps are unchanged.
TransferLayout as_combined(const TransferLayout& layout);
Transfer as_combined(const Transfer& transfer, int threads = 0);
/// Merges the terms of one vector [layout.dimension()].
std::vector<float> as_combined(std::span<const float> transfer, const TransferLayout& layout);

/// Returns the area-weighted mean of T_0 / Y_00, summed over all terms except lamps and averaged over the
/// channels: the fraction of a uniform sky's light that arrives.
double mean_visibility(const Transfer& transfer, std::span<const float> areas);

} // namespace prt

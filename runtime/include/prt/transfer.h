#pragma once

// Raw transfer vectors, as the baker makes them. Stable.

#include "prt/support/glm_layout.h"
#include "prt/transfer_layout.h"

#include <glm/vec3.hpp>

#include <span>
#include <utility>
#include <vector>

namespace prt {

/// Largest magnitude of a number of transfer that files hold: light that is scattered often adds up to a few,
/// and far beyond squares and sums of what is lit pass what a float holds.
inline constexpr float kLargestTransfer = 1e6f;

/// The transfer vectors of a list of receivers: exit radiance of a Lambertian receiver of albedo rho is
/// R_c = rho_c · sum_i T[c][i] L_c[i] (docs/math.md, eq. 7).
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
/// Of a single part.
inline Transfer zero_transfer(int order, int channels, std::size_t receivers) {
    return zero_transfer(layout_of_one(order, channels), receivers);
}

/// The sum over all parts of one transfer vector [layout.dimension()], lit by `columns` of `light_columns`;
/// the one channel of a grey part serves all colors.
glm::vec3 exit_radiance(std::span<const float> transfer, const TransferLayout& layout,
                        std::span<const glm::vec3> columns);

/// Exit radiance of every receiver for albedo 1, [receivers]. Throws `Error` if the lighting has fewer bands.
std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Lighting& lighting, int threads = 0);
/// All light in one sky.
std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Light& light, int threads = 0);

/// With all distant light in one part, of as many channels as it needs: a sky and its suns then light it
/// alike. Lamps stay what they are.
TransferLayout as_whole(const TransferLayout& layout);
Transfer as_whole(const Transfer& transfer, int threads = 0);
/// The same of one vector [layout.dimension()].
std::vector<float> as_whole(std::span<const float> transfer, const TransferLayout& layout);

/// Area-weighted mean of the sum of T_0 / Y_00 over the parts but lamps, each the mean over its channels: the
/// share of a uniform sky's light that arrives.
double mean_visibility(const Transfer& transfer, std::span<const float> areas);

} // namespace prt

#pragma once

// Raw transfer vectors, as the baker makes them. Stable.

#include "prt/light.h"
#include "prt/sh_basis.h"
#include "prt/support/glm_layout.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// The transfer vectors of a list of receivers: exit radiance of a Lambertian receiver of albedo rho is
/// R_c = rho_c · sum_i T[c][i] L_c[i] (docs/math.md, eq. 7).
struct Transfer {
    int order = 0;
    int channels = 1;           ///< 1: the same for red, green and blue; else 3
    std::vector<float> vectors; ///< [receivers][channels][order²]

    std::size_t dimension() const { return static_cast<std::size_t>(channels * coefficient_count(order)); }
    std::size_t receivers() const { return dimension() == 0 ? 0 : vectors.size() / dimension(); }
    std::span<const float> vector(std::size_t receiver) const {
        return std::span(vectors).subspan(receiver * dimension(), dimension());
    }
    std::span<float> vector(std::size_t receiver) {
        return std::span(vectors).subspan(receiver * dimension(), dimension());
    }
};

inline Transfer zero_transfer(int order, int channels, std::size_t receivers) {
    Transfer transfer{order, channels, {}};
    transfer.vectors.resize(receivers * transfer.dimension());
    return transfer;
}

/// sum_i T[c][i] L_c[i] of one transfer vector [channels][order²]; channel 0 serves all colors when there is
/// one.
glm::vec3 exit_radiance(std::span<const float> transfer, int channels, const Light& light);

/// Exit radiance of every receiver for albedo 1, [receivers]. Throws `Error` if `light` has fewer bands.
std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Light& light, int threads = 0);

/// Area-weighted mean of T_0 / Y_00 over all channels: the share of a uniform sky's light that arrives.
double mean_visibility(const Transfer& transfer, std::span<const float> areas);

} // namespace prt

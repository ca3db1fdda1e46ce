#pragma once

// Raw transfer vectors, which the baker produces, and exit radiance computed from them on the CPU. Stable.

#include "prt/core/glm_layout.h"
#include "prt/core/transfer_layout.h"

#include <glm/vec3.hpp>

#include <span>
#include <utility>
#include <vector>

namespace prt {

/// Maximum magnitude of a transfer coefficient. Functions that read files throw `Error` for larger ones.
/// Valid coefficients are far smaller, even with many bounces. With much larger coefficients, sums of squares
/// of exit radiance would overflow a float.
inline constexpr float kMaxTransfer = 1e6f;

/// The transfer vectors of a list of receivers. A term T of a vector adds R_c = rho_c · sum_i T[c][i] L_c[i]
/// to the exit radiance of a Lambertian receiver: c is the channel, rho the albedo, and L the lighting of the
/// term (docs/math.md, eq. 7).
struct Transfer {
    TransferLayout layout;      ///< the same for all receivers
    std::vector<float> vectors; ///< [receivers][layout.dimension()]

    /// Number of coefficients of one transfer vector.
    std::size_t dimension() const { return layout.dimension(); }
    /// Number of receivers; 0 if dimension() is 0, for example because the layout has no terms.
    std::size_t receivers() const { return dimension() == 0 ? 0 : vectors.size() / dimension(); }
    /// Returns the transfer vector [dimension()] of the receiver with the index `receiver` < receivers(), as
    /// a view of `vectors`.
    std::span<const float> vector(std::size_t receiver) const {
        return std::span(vectors).subspan(receiver * dimension(), dimension());
    }
    /// Returns the transfer vector [dimension()] of the receiver with the index `receiver` < receivers(), as
    /// a view of `vectors` through which it can be changed.
    std::span<float> vector(std::size_t receiver) {
        return std::span(vectors).subspan(receiver * dimension(), dimension());
    }
};

/// Returns transfer with the given layout for `receivers` receivers; all coefficients are 0.
inline Transfer zero_transfer(TransferLayout layout, std::size_t receivers) {
    Transfer transfer{std::move(layout), {}};
    transfer.vectors.resize(receivers * transfer.dimension());
    return transfer;
}
/// Returns transfer for `receivers` receivers with a single term of kind `combined`, of `order` bands and
/// `channels` (1 or 3) channels; all coefficients are 0.
inline Transfer zero_transfer(int order, int channels, std::size_t receivers) {
    return zero_transfer(layout_of_one(order, channels), receivers);
}

/// Returns the exit radiance of one receiver for albedo 1, from its transfer vector `transfer`
/// [layout.dimension()]: the sum over all terms. `columns` is the result of `light_columns` for the same
/// layout. A term with one channel uses it for red, green and blue. Requires layout.outputs = 1. Sizes are
/// not checked.
glm::vec3 exit_radiance(std::span<const float> transfer, const TransferLayout& layout,
                        std::span<const glm::vec3> columns);

/// Returns the exit radiance of every receiver for albedo 1, [receivers], in the unit of the radiance of
/// `lighting`. `threads`: number of threads; 0: all hardware threads. Requires layout.outputs = 1. Throws the
/// errors of `light_columns`.
std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Lighting& lighting, int threads = 0);
/// Returns the exit radiance of every receiver for albedo 1, [receivers], in the unit of the radiance of
/// `light`. `light` is the whole sky including its suns; every lamp has the strength 1, as in the scene.
/// `threads`: number of threads; 0: all hardware threads. Requires layout.outputs = 1. Throws `Error` if
/// `light` has fewer bands than the layout, also if all terms are lamps.
std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Light& light, int threads = 0);

/// Returns a layout in which one `combined` term replaces all terms of distant light (`direct`, `indirect`,
/// both, or `combined`). The new term has three channels if a replaced term has three, else one. Lamp terms
/// are unchanged. Without terms of distant light the result has only the lamp terms. Requires
/// `layout.outputs` = 1.
TransferLayout as_combined(const TransferLayout& layout);
/// Returns transfer in which one `combined` term, their sum, replaces all terms of distant light of each
/// receiver. Its layout is `as_combined(transfer.layout)`; lamp terms are unchanged. Exit radiance is the
/// same, except for rounding, if all distant light is in the sky, without separate suns. `threads`: number of
/// threads; 0: all hardware threads. Requires layout.outputs = 1.
Transfer as_combined(const Transfer& transfer, int threads = 0);
/// Returns the transfer vector of one receiver, in which one `combined` term, their sum, replaces all terms
/// of distant light; lamp terms are unchanged. `transfer` is [layout.dimension()]; the result has the layout
/// `as_combined(layout)`. Requires layout.outputs = 1.
std::vector<float> as_combined(std::span<const float> transfer, const TransferLayout& layout);

/// Returns the mean visibility: the fraction of a uniform sky's light that arrives at the receivers, averaged
/// with the weights `areas` [receivers] (docs/math.md, eq. 34). Terms of distant light are summed, and the
/// channels of each term are averaged; lamps do not count. Returns 0 if the sum of the areas is 0, or if the
/// layout has no terms of distant light. Requires layout.outputs = 1.
double mean_visibility(const Transfer& transfer, std::span<const float> areas);

} // namespace prt

#pragma once

#include "core/screen.h"
#include "pictures/model.h"

#include <glm/vec2.hpp>

#include <optional>
#include <vector>

namespace viewer {

/// The receiver under the pointer, a vertex or a texel.
struct Hovered {
    Receivers of = Receivers::vertices;
    std::uint32_t receiver = 0; ///< texels are numbered map by map
    glm::vec3 position{0};
    std::vector<float>
        vector; ///< combined transfer vector of the first channel, [order²]; empty without transfer
    int order = 0;
    int cluster = -1;           ///< cluster of compressed transfer; -1: not compressed
    std::vector<float> weights; ///< weights of the receiver in its cluster
};

/// Returns the nearest vertex of the triangle at `pixel`, or the nearest texel. The vector is the compressed
/// one if it exists, unless `prefer_raw`.
std::optional<Hovered> find_hovered(const LoadedModel& loaded, bool prefer_raw, const Screen& screen,
                                    const glm::vec2& pixel);

} // namespace viewer

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
    std::uint32_t receiver = 0; ///< texels are numbered map behind map
    glm::vec3 position{0};
    std::vector<float>
        vector; ///< transfer, [order²] all parts, of the first channel; empty where there is none
    int order = 0;
    int cluster = -1;           ///< where it is compressed
    std::vector<float> weights; ///< the cluster's
};

/// The nearest vertex of the triangle at `pixel`, or the nearest texel. Its vector is the compressed one
/// where there is one, unless `prefer_raw`.
std::optional<Hovered> find_hovered(const LoadedModel& loaded, bool prefer_raw, const Screen& screen,
                                    const glm::vec2& pixel);

} // namespace viewer

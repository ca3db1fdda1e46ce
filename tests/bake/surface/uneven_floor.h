#pragma once

#include "support/scene_builder.h"

#include <cmath>

namespace prt::test {

/// A square of cells that are shifted about.
inline Scene uneven_floor(int cells) {
    return SceneBuilder()
        .floor({0, 0, 0}, 1, cells)
        .transform([](const glm::vec3& p) {
            return glm::vec3(p.x + 0.07f * std::sin(9 * p.z), 0, p.z + 0.07f * std::sin(11 * p.x));
        })
        .build();
}

} // namespace prt::test

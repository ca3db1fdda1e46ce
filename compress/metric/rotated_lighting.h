#pragma once

#include "prt/core/light.h"
#include "prt/core/transfer_layout.h"

namespace prt {

/// Returns the first bands of `lighting`, rotated about +Y by `angle` radians; lamps stay as they are.
inline Lighting rotated_about_y(const Lighting& lighting, int order, double angle) {
    Lighting result{rotated_about_y(truncated(lighting.sky, order), angle), {}, lighting.lamps};
    if (lighting.suns)
        result.suns = rotated_about_y(truncated(*lighting.suns, order), angle);
    return result;
}

} // namespace prt

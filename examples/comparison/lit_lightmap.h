#pragma once

#include "pictures/model.h"

#include "prt/core/clustered_transfer.h"
#include "prt/core/lightmap.h"

#include <filesystem>
#include <memory>

namespace comparison {

/// A scene with a lightmap as a game has it.
struct LitLightmap {
    std::shared_ptr<const viewer::Model> model; ///< cut into charts
    prt::CompressedLightmap lightmap;
    double bytes_per_texel = 0; ///< with the bases, shared out among texels of the surface
};

/// Cuts `scene` into charts of one map of `size` texels along each side, bakes it to order `order` with
/// endless bounces, and compresses it to eight bytes per texel.
LitLightmap make_lightmap(const std::filesystem::path& scene, int size, int order, int rays);

} // namespace comparison

#pragma once

#include "cli/report/report.h"
#include "prt/bake/lightmap_bake.h"

#include <cstdint>
#include <string>

namespace prt::pipeline {

/// Result of a bake into texels.
struct LightmapOutcome {
    std::string output;
    const Scene& scene; ///< the baked scene
    const LightmapBake& bake;
    std::uintmax_t bytes = 0; ///< file size
};

Report lightmap_report(const LightmapOutcome& baked);

/// Returns the sizes of the maps: [{"width": 512, "height": 512}, ...]
Json maps_figures(const LightmapLayout& layout);
/// "2 maps, 512 x 512 and 256 x 256"
std::string maps_in_words(const LightmapLayout& layout);

} // namespace prt::pipeline

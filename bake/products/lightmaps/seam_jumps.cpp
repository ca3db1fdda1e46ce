// Finds the receivers that filters read on both sides of seams, for the compressor.

#include "bake/products/lightmaps/seams.h"
#include "prt/bake/lightmap_bake.h"

#include <algorithm>

namespace prt {

std::vector<Atlas> atlases_of(const LightmapLayout& layout) {
    std::vector<Atlas> atlases(layout.maps.size());
    for (std::size_t a = 0; a < atlases.size(); ++a) {
        const LightmapSize& map = layout.maps[a];
        atlases[a].width = map.width;
        atlases[a].height = map.height;
        atlases[a].repeats = map.repeats;
    }
    for (std::size_t p = 0; p < layout.placements.size(); ++p) {
        if (layout.placements[p].map == kNoMap)
            continue;
        Atlas& atlas = atlases[layout.placements[p].map];
        atlas.primitives.push_back(p);
        atlas.uv_set = layout.placements[p].texcoord;
    }
    return atlases;
}

std::vector<SeamJump> seam_jumps(const Scene& scene, const LightmapLayout& layout,
                                 std::span<const std::uint32_t> texels) {
    std::vector<SeamJump> jumps;
    const std::vector<std::size_t> first = layout.first_texels();
    const std::vector<Atlas> atlases = atlases_of(layout);
    for (std::size_t a = 0; a < atlases.size(); ++a)
        for (const SeamPoint& point : seam_points(scene, atlases[a])) {
            SeamJump jump;
            std::size_t i = 0;
            bool there = true; // a file may lack texels that its seams read: these jumps are ignored
            for (const auto& [position, sign] : {std::pair(point.here, 1.0), std::pair(point.there, -1.0)}) {
                const BilinearTexels filter = bilinear_at(atlases[a], position);
                for (std::size_t k = 0; k < 4; ++k, ++i) {
                    const std::size_t texel = first[a] + filter.texels[k];
                    const auto found = std::ranges::lower_bound(texels, texel);
                    there = there && found != texels.end() && *found == texel;
                    jump.receivers[i] = static_cast<std::uint32_t>(found - texels.begin());
                    jump.weights[i] = static_cast<float>(sign * filter.weights[k]);
                }
            }
            if (there)
                jumps.push_back(jump);
        }
    return jumps;
}

} // namespace prt

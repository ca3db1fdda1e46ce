// Evaluates raw or compressed lightmap transfer at some texels.

#include "core/texel_light.h"

#include "prt/render/lightmap_file.h"

#include <algorithm>

namespace viewer {
std::vector<glm::vec3> texel_radiance(const LoadedModel& loaded, const prt::Lighting& lighting,
                                      std::span<const std::uint32_t> texels) {
    if (loaded.compressed)
        return prt::exit_radiance(prt::gather_texels(*loaded.compressed, texels), lighting, 1);
    const std::vector<glm::vec3> columns = prt::light_columns(loaded.raw->layout, lighting);
    std::vector<glm::vec3> radiance;
    for (const std::uint32_t texel : texels) {
        const auto receiver = receiver_of(loaded.lightmap.baked->texels, texel);
        radiance.push_back(
            receiver ? prt::exit_radiance(loaded.raw->vector(*receiver), loaded.raw->layout, columns)
                     : glm::vec3(0));
    }
    return radiance;
}

std::optional<std::size_t> receiver_of(std::span<const std::uint32_t> texels, std::uint32_t texel) {
    const auto at = std::ranges::lower_bound(texels, texel);
    if (at == texels.end() || *at != texel)
        return std::nullopt;
    return static_cast<std::size_t>(at - texels.begin());
}

} // namespace viewer

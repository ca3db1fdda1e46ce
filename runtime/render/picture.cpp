// Background and emission of pictures, for all renderers.
#include "prt/render/picture.h"

#include <algorithm>
#include <cmath>

namespace prt {

glm::vec3 background_radiance(const Picture& picture, const glm::vec3& direction) {
    if (!picture.background.image)
        return glm::vec3(0);
    const float c = std::cos(picture.background.rotation), s = std::sin(picture.background.rotation);
    const glm::vec3 unturned(c * direction.x - s * direction.z, direction.y,
                             s * direction.x + c * direction.z);
    return sample_lat_long(*picture.background.image, unturned);
}

std::vector<glm::vec3> emission_strengths(const Scene& scene, const TransferLayout& layout,
                                          std::span<const glm::vec3> lamps) {
    std::vector<glm::vec3> strengths(scene.materials.size(), glm::vec3(1));
    if (lamps.empty())
        return strengths;
    for (std::size_t m = 0; m < strengths.size(); ++m) {
        const std::string name = lamp_name(scene, m);
        auto strength = lamps.begin();
        for (const TransferTerm& lamp : layout.lamp_terms()) {
            if (lamp.has_member(name))
                strengths[m] = *strength;
            ++strength;
        }
    }
    return strengths;
}

} // namespace prt

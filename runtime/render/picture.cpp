// What any renderer checks of a picture.
#include "prt/picture.h"

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
    const std::size_t skies = layout.parts.size() - layout.lamps();
    for (std::size_t m = 0; m < strengths.size(); ++m)
        for (std::size_t k = 0; k < layout.lamps(); ++k) {
            const TransferPart& part = layout.parts[skies + k];
            const std::string name = lamp_name(scene, m);
            const bool member =
                std::find(part.members.begin(), part.members.end(), name) != part.members.end();
            if (member || (part.members.empty() && part.name == name))
                strengths[m] = lamps[k];
        }
    return strengths;
}

} // namespace prt

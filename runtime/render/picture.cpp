// What any renderer checks of a picture.
#include "prt/picture.h"

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

} // namespace prt

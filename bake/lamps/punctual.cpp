// The cone and the range of KHR_lights_punctual.

#include "lamps/punctual.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt {

double cone_share(const PunctualLight& light, const glm::dvec3& along) {
    if (light.kind != PunctualKind::spot)
        return 1;
    const double inner = std::cos(static_cast<double>(light.inner_cone)),
                 outer = std::cos(static_cast<double>(light.outer_cone));
    const double share = std::clamp(
        (glm::dot(glm::dvec3(light.direction), along) - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
    return share * share;
}

double range_share(const PunctualLight& light, double distance) {
    const double ratio = distance / static_cast<double>(light.range);
    return std::clamp(1 - ratio * ratio * ratio * ratio, 0.0, 1.0);
}

} // namespace prt

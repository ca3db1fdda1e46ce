// The cone and the range of KHR_lights_punctual.

#include "bake/scene/punctual.h"

#include "shared_lamps.h"

#include <cmath>

namespace prt {

ConeCosines cone_cosines(const PunctualLight& light) {
    if (light.kind != PunctualKind::spot)
        return {-2, -3};
    return {std::cos(static_cast<double>(light.inner_cone)), std::cos(static_cast<double>(light.outer_cone))};
}

double cone_share(const PunctualLight& light, const glm::dvec3& along) {
    const ConeCosines cone = cone_cosines(light);
    return lamp_geometry::share_in_cone(glm::dot(glm::dvec3(light.direction), along), cone.inner, cone.outer);
}

double range_share(const PunctualLight& light, double distance) {
    return lamp_geometry::share_in_range(distance / static_cast<double>(light.range));
}

} // namespace prt

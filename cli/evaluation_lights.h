#pragma once

#include "inputs.h"

#include <vector>

namespace prt::cli {

/// A light turned about +Y by `count` equal angles, named after them.
std::vector<LoadedLight> rotations(LoadedLight light, int count);

/// Suns all over the sphere, evenly spread.
struct DirectionalLights {
    std::vector<Light> lights;
    std::vector<glm::vec3> directions;
};
DirectionalLights directional_lights(int order);

/// White light whose coefficients are independent and normally distributed, of one fixed seed: every error of
/// a coefficient counts alike.
Light random_white_light(int order);

} // namespace prt::cli

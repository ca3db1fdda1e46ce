#pragma once

#include "split_light.h"

#include <vector>

namespace prt::cli {

/// What to evaluate under when the user names no lights: uniform, overcast, and a sun high in the front.
std::vector<SplitLight> default_lights(int order);

/// A light turned about +Y by `count` equal angles, named after them.
std::vector<SplitLight> rotations(SplitLight light, int count);

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

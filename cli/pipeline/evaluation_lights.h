#pragma once

#include "cli/pipeline/loaded_light.h"

#include <vector>

namespace prt::pipeline {

/// Returns the lights of an evaluation without named lights: uniform, overcast, and a high sun in front.
std::vector<LoadedLight> default_lights(int order);

/// Returns a light rotated about +Y by `count` equal angles; the names contain the angles.
std::vector<LoadedLight> rotations(LoadedLight light, int count);

/// Suns evenly distributed over the sphere.
struct DirectionalLights {
    std::vector<Light> lights;
    std::vector<glm::vec3> directions;
};
DirectionalLights directional_lights(int order);

/// Returns white light whose coefficients are independent and normally distributed, with a fixed seed: errors
/// of all coefficients have equal weight.
Light random_white_light(int order);

} // namespace prt::pipeline

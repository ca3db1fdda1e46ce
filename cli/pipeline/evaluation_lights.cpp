// Returns the standard lights of an evaluation.

#include "cli/pipeline/evaluation_lights.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <random>

namespace prt::pipeline {

std::vector<LoadedLight> default_lights(int order) {
    const auto sky = [](std::string name, Light light) {
        return LoadedLight{.name = std::move(name), .sky = light, .combined = light};
    };
    const Sun sun{glm::normalize(glm::vec3(0.5f, 1, 0.7f)), glm::vec3(1)};
    LoadedLight sunny = sky("sun", constant_light(order, glm::vec3(0)));
    sunny.split.suns = {sun};
    sunny.combined = as_light(sun, order);
    return {sky("uniform", constant_light(order, glm::vec3(1))),
            sky("overcast sky", overcast_sky(order, glm::vec3(1))), std::move(sunny)};
}

std::vector<LoadedLight> rotations(LoadedLight light, int count) {
    std::vector<LoadedLight> result;
    for (int r = 1; r < count; ++r) {
        const double degrees = 360.0 * r / count;
        result.push_back(rotated(light, glm::radians(degrees)));
        result.back().name = fmt::format("{} +{:g}°", light.name, degrees);
    }
    result.insert(result.begin(), std::move(light));
    return result;
}

DirectionalLights directional_lights(int order) {
    constexpr int kCount = 64;
    DirectionalLights result;
    for (int i = 0; i < kCount; ++i) { // a spherical Fibonacci lattice
        const double y = 1 - (2 * i + 1.0) / kCount, radius = std::sqrt(1 - y * y);
        const double angle = 2 * M_PI * 0.61803398875 * i;
        result.directions.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
        result.lights.push_back(directional_light(order, result.directions.back(), glm::vec3(1)));
    }
    return result;
}

Light random_white_light(int order) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    Light light{order, {}};
    for (int i = 0; i < coefficient_count(order); ++i)
        light.coefficients.emplace_back(normal(random));
    return light;
}

} // namespace prt::pipeline

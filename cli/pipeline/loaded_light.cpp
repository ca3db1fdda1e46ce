// Loads lights and separates their suns.

#include "cli/pipeline/loaded_light.h"

#include "prt/load/light_file.h"

#include <fmt/core.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace prt::pipeline {
Light light_of_suns(const LoadedLight& light) {
    return as_light(light.split.suns, light.sky.order);
}

Lighting lighting_of(const LoadedLight& light) {
    if (light.split.suns.empty())
        return {light.sky};
    return {light.sky, light_of_suns(light)};
}

LoadedLight dark_sky(int order) {
    LoadedLight dark;
    dark.name = "no sky";
    dark.sky = dark.combined = constant_light(order, glm::vec3(0));
    return dark;
}

LoadedLight together(LoadedLight light) {
    light.sky = light.combined;
    light.split.suns.clear();
    return light;
}

std::vector<Sun> rotated(std::vector<Sun> suns, double angle) {
    for (Sun& sun : suns)
        sun.towards = glm::vec3(glm::rotate(glm::dmat4(1), angle, glm::dvec3(0, 1, 0)) *
                                glm::dvec4(glm::dvec3(sun.towards), 0));
    return suns;
}

LoadedLight rotated(LoadedLight light, double angle) {
    light.environment.reset();
    light.sky = rotated_about_y(light.sky, angle);
    light.combined = rotated_about_y(light.combined, angle);
    light.split.suns = rotated(std::move(light.split.suns), angle);
    return light;
}

namespace {

/// Filters and rotates the light; without separate suns, all of it is in the sky.
LoadedLight shown(LoadedLight light, bool separate, const LightOptions& options) {
    light.combined = windowed(light.combined, options.window);
    light.sky = separate ? windowed(light.sky, options.window) : light.combined;
    if (const double rotation = glm::radians(options.rotation_degrees); rotation != 0)
        light = rotated(std::move(light), rotation);
    return light;
}

} // namespace

LoadedLight light_of_environment(Environment image, int order, const SunCount& suns,
                                 const LightOptions& options, int threads) {
    const bool separate = suns.count != 0;
    LoadedLight result;
    if (separate) {
        result.split = find_suns(image, {.order = order, .count = suns.count, .threads = threads});
        result.sky = project(result.split.remainder, order, threads);
    }
    result.combined = project(image, order, threads);
    result = shown(std::move(result), separate, options);
    result.environment = std::move(image);
    return result;
}

LoadedLight load_light(const Path& path, int order, const SunCount& suns, const LightOptions& options,
                       int threads) {
    LoadedLight result;
    if (suffix_of(path) == ".json") {
        LightFile file = read_light_file(path, order);
        result.combined = all_light(file);
        if (suns.count != 0) {
            result.sky = std::move(file.sky);
            result.split.suns = std::move(file.suns);
        }
        result = shown(std::move(result), suns.count != 0, options);
    } else {
        Environment image = load_environment_map(path, options.environment, options.notify);
        result = about(path,
                       [&] { return light_of_environment(std::move(image), order, suns, options, threads); });
    }
    result.name = path.filename().string();
    return result;
}

} // namespace prt::pipeline

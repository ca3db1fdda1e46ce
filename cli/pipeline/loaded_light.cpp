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

LoadedLight load_light(const Path& path, int order, const SunCount& suns, const LightOptions& options,
                       int threads) {
    const bool separate = suns.count != 0;
    LoadedLight result;
    result.name = path.filename().string();
    std::optional<Environment> image;
    if (suffix_of(path) == ".json") {
        LightFile file = read_light_file(path, order);
        result.combined = all_light(file);
        if (separate) {
            result.sky = std::move(file.sky);
            result.split.suns = std::move(file.suns);
        }
    } else {
        image = load_environment_map(path, options.environment, options.notify);
        if (separate) {
            result.split = about(path, [&] {
                return find_suns(*image, {.order = order, .count = suns.count, .threads = threads});
            });
            result.sky = project(result.split.remainder, order, threads);
        }
        result.combined = about(path, [&] { return project(*image, order, threads); });
    }
    result.combined = windowed(result.combined, options.window);
    result.sky = separate ? windowed(result.sky, options.window) : result.combined;
    if (const double rotation = glm::radians(options.rotation_degrees); rotation != 0)
        result = rotated(std::move(result), rotation);
    result.environment = std::move(image);
    return result;
}

} // namespace prt::pipeline

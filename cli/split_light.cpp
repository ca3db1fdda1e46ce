// Loads lights and separates their suns.

#include "split_light.h"

#include "options.h"
#include "outputs.h"
#include "prt/light_file.h"

#include <fmt/core.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace prt::cli {
namespace {

/// Returns the error of a value of `--suns`; empty if it is valid.
std::string sun_count(const std::string& text) {
    const std::optional<int> count = whole_number(text);
    return text == "auto" || (count && *count >= 0 && *count <= 16) ? ""
                                                                    : text + " is neither auto nor 0..16";
}

} // namespace

void add_suns(CLI::App* command, SunCount& suns, const std::string& text, const std::string& otherwise) {
    command
        ->add_option_function<std::string>(
            "--suns",
            [&suns](const std::string& given) {
                suns.count = given == "auto" ? std::nullopt : whole_number(given);
            },
            text)
        ->check(sun_count)
        ->type_name("0..16|auto")
        ->default_str(otherwise);
}

Light light_of_suns(const SplitLight& light) {
    return as_light(light.split.suns, light.sky.light.order);
}

Lighting lighting_of(const SplitLight& light) {
    if (light.split.suns.empty())
        return {light.sky.light};
    return {light.sky.light, light_of_suns(light)};
}

SplitLight dark_sky(int order) {
    SplitLight dark;
    dark.sky.name = "no sky";
    dark.sky.light = dark.whole = constant_light(order, glm::vec3(0));
    return dark;
}

SplitLight together(SplitLight light) {
    light.sky.light = light.whole;
    light.split.suns.clear();
    return light;
}

SplitLight rotated(SplitLight light, double angle) {
    light.sky.environment.reset();
    light.sky.light = rotated_about_y(light.sky.light, angle);
    light.whole = rotated_about_y(light.whole, angle);
    for (Sun& sun : light.split.suns)
        sun.towards = glm::vec3(glm::rotate(glm::dmat4(1), angle, glm::dvec3(0, 1, 0)) *
                                glm::dvec4(glm::dvec3(sun.towards), 0));
    return light;
}

SplitLight load_split_light(const Path& path, int order, const SunCount& suns, const LightOptions& options,
                            int threads) {
    SplitLight result;
    if (suns.count == 0) {
        result.sky = load_light(path, order, options, threads);
        result.whole = result.sky.light;
        return result;
    }
    result.sky.name = path.filename().string();
    if (suffix_of(path) == ".json") {
        LightFile file = read_light_file(path, order);
        result.whole = all_light(file);
        result.sky.light = std::move(file.sky);
        result.split.suns = std::move(file.suns);
    } else {
        result.sky.environment = load_environment_map(path, options.environment);
        const Environment& image = *result.sky.environment;
        result.split = about(path, [&] {
            return find_suns(image, {.order = order, .count = suns.count, .threads = threads});
        });
        result.whole = project(image, order, threads);
        result.sky.light = project(result.split.remainder, order, threads);
    }
    result.sky.light = windowed(result.sky.light, options.window);
    result.whole = windowed(result.whole, options.window);
    if (const double rotation = glm::radians(options.rotation_degrees); rotation != 0) {
        auto image = std::move(result.sky.environment);
        result = rotated(std::move(result), rotation);
        result.sky.environment = std::move(image);
    }
    return result;
}

} // namespace prt::cli

#include "commands/commands.h"

#include "inputs.h"
#include "light_file.h"
#include "outputs.h"
#include "prt/sh.h"
#include "prt/sun_fit.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"
#include "report/write_report.h"

#include <fmt/core.h>
#include <glm/trigonometric.hpp>

namespace prt::cli {
namespace {

const char* layout_name(EnvironmentLayout layout) {
    switch (layout) {
    case EnvironmentLayout::cube:
        return "cube";
    case EnvironmentLayout::cube_faces:
        return "cube-faces";
    case EnvironmentLayout::angular:
        return "angular";
    case EnvironmentLayout::lat_long:
        break;
    }
    return "lat-long";
}

/// A window is for what is left: a blurred sun is not found.
LightOptions without_window(LightOptions options) {
    options.window = Window::none;
    return options;
}

Json lights_json(const std::vector<FittedLight>& lights) {
    Json list = Json::array();
    for (const FittedLight& light : lights)
        list.push_back({{"towards", {light.towards.x, light.towards.y, light.towards.z}},
                        {"irradiance", {light.irradiance.r, light.irradiance.g, light.irradiance.b}},
                        {"half_angle_radians", light.half_angle},
                        {"energy_share", light.energy_share}});
    return list;
}

void print_lights(const std::vector<FittedLight>& lights) {
    double rest = 1;
    for (const FittedLight& light : lights) {
        fmt::print("  light towards {:.4f} {:.4f} {:.4f}, irradiance {:.4g} {:.4g} {:.4g}, half angle {:.1f} "
                   "degrees: "
                   "{:.1f} % of the energy\n",
                   light.towards.x, light.towards.y, light.towards.z, light.irradiance.r, light.irradiance.g,
                   light.irradiance.b, glm::degrees(light.half_angle), 100 * light.energy_share);
        rest -= light.energy_share;
    }
    fmt::print("  the coefficients hold the other {:.1f} %\n", 100 * rest);
}

} // namespace

void run(const ProjectArguments& a, Interrupt& interrupt) {
    // A light file is known by its name.
    check_outputs({{a.output, "--output", {".json"}, true}, {a.json, "--json", {".json"}}}, {a.environment});
    check_order(a.order);
    if (a.suns > 0 && suffix_of(a.environment) == ".json")
        throw Error(a.environment.string() + ": is a light file, and suns are fitted to images");
    const Stopwatch stopwatch;
    LoadedLight loaded =
        load_light(a.environment, a.suns > 0 ? kMaxOrder : a.order,
                   a.suns > 0 ? without_window(a.light_options) : a.light_options, a.threads);
    std::vector<FittedLight> suns;
    if (a.suns > 0) {
        SunFit fit = fit_suns(loaded.light, a.order, a.suns);
        suns = std::move(fit.lights);
        loaded.light = windowed(fit.remainder, a.light_options.window);
    }
    const double seconds = stopwatch.seconds();
    Json file = light_json(loaded.light);
    if (a.suns > 0)
        file["lights"] = lights_json(suns);
    write_json(file, a.output, interrupt);

    const glm::vec3 mean = loaded.light.coefficients[0] * static_cast<float>(kY00);
    fmt::print("{}: order {}, mean radiance {:.4g} {:.4g} {:.4g}\n", a.output.string(), a.order, mean.r,
               mean.g, mean.b);
    if (a.suns > 0)
        print_lights(suns);
    Json report = {{"output", a.output.string()},
                   {"order", a.order},
                   {"mean_radiance", {mean.r, mean.g, mean.b}},
                   {"seconds", seconds}};
    if (a.suns > 0)
        report["lights"] = lights_json(suns);
    if (loaded.environment) {
        const Environment& environment = *loaded.environment;
        const char* layout = layout_name(environment.layout);
        fmt::print("  from a {} image of {} x {}\n", layout, environment.image.width,
                   environment.image.height);
        report["layout"] = layout;
        report["width_pixels"] = environment.image.width;
        report["height_pixels"] = environment.image.height;
    }
    write_json(report, a.json, interrupt);
}

} // namespace prt::cli

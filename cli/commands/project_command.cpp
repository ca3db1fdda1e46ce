#include "commands/commands.h"

#include "light_file.h"
#include "options.h"
#include "outputs.h"
#include "prt/sh.h"
#include "prt/sun_fit.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"

#include <fmt/core.h>
#include <glm/trigonometric.hpp>

namespace prt::cli {
namespace {

struct ProjectArguments {
    Path environment, output, json;
    int order = 6;
    int suns = 0; ///< lights to take out
    LightOptions light_options;
    int threads = 0;
};

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

void add_lights(const std::vector<FittedLight>& lights, Report& report) {
    double rest = 1;
    for (const FittedLight& light : lights) {
        report.sentences.push_back(fmt::format(
            "light towards {:.4f} {:.4f} {:.4f}, irradiance {:.4g} {:.4g} {:.4g}, half angle {:.1f} degrees: "
            "{:.1f} % of the energy",
            light.towards.x, light.towards.y, light.towards.z, light.irradiance.r, light.irradiance.g,
            light.irradiance.b, glm::degrees(light.half_angle), 100 * light.energy_share));
        rest -= light.energy_share;
    }
    report.sentences.push_back(fmt::format("the coefficients hold the other {:.1f} %", 100 * rest));
    add_figures(report, {{"lights", lights_json(lights)}});
}

/// The light of an environment, and the suns that were taken out of it.
std::pair<LoadedLight, std::vector<FittedLight>> project(const ProjectArguments& a) {
    if (a.suns == 0)
        return {load_light(a.environment, a.order, a.light_options, a.threads), {}};
    LoadedLight loaded = load_light(a.environment, kMaxOrder, without_window(a.light_options), a.threads);
    SunFit fit = fit_suns(loaded.light, a.order, a.suns);
    loaded.light = windowed(fit.remainder, a.light_options.window);
    return {std::move(loaded), std::move(fit.lights)};
}

void run(const ProjectArguments& a, Session& session) {
    // A light file is known by its name.
    check_outputs({{a.output, "--output", {".json"}, true}, {a.json, "--json", {".json"}}}, {a.environment});
    if (a.suns > 0 && suffix_of(a.environment) == ".json")
        throw Error(a.environment.string() + ": is a light file, and suns are fitted to images");
    const Stopwatch stopwatch;
    const auto [loaded, suns] = project(a);
    const double seconds = stopwatch.seconds();
    Json file = light_json(loaded.light);
    if (a.suns > 0)
        file["lights"] = lights_json(suns);
    session.write(a.output, json_text(file));

    const glm::vec3 mean = loaded.light.coefficients[0] * static_cast<float>(kY00);
    Report report;
    add_figures(report, {{"output", a.output.string()},
                         {"order", a.order},
                         {"mean_radiance", {mean.r, mean.g, mean.b}},
                         {"seconds", seconds}});
    report.sentences = {"{output}: order {order}, mean radiance {mean_radiance/0:.4g} {mean_radiance/1:.4g} "
                        "{mean_radiance/2:.4g}"};
    if (a.suns > 0)
        add_lights(suns, report);
    if (loaded.environment) {
        add_figures(report, {{"layout", layout_name(loaded.environment->layout)},
                             {"width_pixels", loaded.environment->image.width},
                             {"height_pixels", loaded.environment->image.height}});
        report.sentences.emplace_back("from a {layout} image of {width_pixels} x {height_pixels}");
    }
    publish(report, a.json, session);
}

} // namespace

void add_project(CLI::App& app, Session& session) {
    CLI::App* command = app.add_subcommand("project", "Project an environment map into SH lighting");
    auto& a = arguments_for<ProjectArguments>(
        command, [&session](const ProjectArguments& given) { run(given, session); });
    command
        ->add_option("environment", a.environment,
                     "environment map, .exr, .hdr, .png or .jpg; with {face} in its name six files px, nx, "
                     "py, ny, pz, nz")
        ->required()
        ->check(named);
    add_output(command, a.output, "light to write, .json");
    command->add_option("--order", a.order, "SH order N, 1..10")
        ->capture_default_str()
        ->check(CLI::Range(1, kMaxOrder));
    command
        ->add_option("--suns", a.suns,
                     "fit so many lights to it, write them apart, and the rest as coefficients")
        ->check(CLI::Range(0, 16))
        ->capture_default_str();
    add_light_options(command, a.light_options);
    add_threads(command, a.threads);
    add_json(command, a.json);
}

} // namespace prt::cli

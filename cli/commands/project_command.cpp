// prt project: converts an environment map to a light file.

#include "cli/commands/commands.h"

#include "cli/arguments/light_arguments.h"
#include "cli/arguments/options.h"
#include "cli/pipeline/loaded_light.h"
#include "cli/pipeline/model.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"
#include "prt/core/error.h"
#include "prt/load/light_file.h"
#include "runtime/core/support/stopwatch.h"

#include <fmt/core.h>
#include <glm/trigonometric.hpp>

namespace prt::cli {
namespace {

struct ProjectArguments {
    Path environment, output, json;
    int order = 6;
    SunCount suns;
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

double degrees_across(const Sun& sun) {
    return 2 * glm::degrees(sun.half_angle);
}

Json light_json(const Light& light) {
    constexpr const char* kChannels[3] = {"red", "green", "blue"};
    Json channels = Json::object();
    for (int c = 0; c < 3; ++c)
        for (const glm::vec3& coefficient : light.coefficients)
            channels[kChannels[c]].push_back(coefficient[c]);
    return {{"prtkit_light", 1}, {"order", light.order}, {"coefficients", channels}};
}

Json suns_json(const SunSplit& split) {
    Json list = Json::array();
    for (std::size_t i = 0; i < split.suns.size(); ++i) {
        const Sun& sun = split.suns[i];
        list.push_back({{"towards", {sun.towards.x, sun.towards.y, sun.towards.z}},
                        {"irradiance", {sun.irradiance.r, sun.irradiance.g, sun.irradiance.b}},
                        {"half_angle_radians", sun.half_angle},
                        {"angular_size_degrees", degrees_across(sun)},
                        {"energy_share", split.energy_shares[i]}});
    }
    return list;
}

void report_suns(const SunSplit& split, Report& report) {
    for (std::size_t i = 0; i < split.suns.size(); ++i) {
        const Sun& sun = split.suns[i];
        report.sentences.push_back(fmt::format(
            "sun towards {:.4f} {:.4f} {:.4f}, irradiance {:.4g} {:.4g} {:.4g}, {:.2f} degrees across: "
            "{:.1f} % of the energy",
            sun.towards.x, sun.towards.y, sun.towards.z, sun.irradiance.r, sun.irradiance.g, sun.irradiance.b,
            degrees_across(sun), 100 * split.energy_shares[i]));
    }
    report.sentences.emplace_back(
        split.suns.empty()
            ? "no sun is separate; the error of light in shadows is {error_without_suns:.1f%}"
            : "the coefficients contain the other {remainder_energy_share:.1f%}; the error of light "
              "in shadows is {error_with_suns:.1f%}, and {error_without_suns:.1f%} without "
              "separate suns");
    add_figures(report, {{"suns", suns_json(split)},
                         {"remainder_energy_share", split.remainder_share},
                         {"error_without_suns", split.error_without},
                         {"error_with_suns", split.error_with}});
}

void run(const ProjectArguments& a, Session& session) {
    // A light file is known by its name.
    check_outputs({{a.output, "--output", {".json"}, true}, {a.json, "--json", {".json"}}}, {a.environment});
    const bool separate = a.suns.count != 0;
    if (separate && suffix_of(a.environment) == ".json")
        throw Error(a.environment.string() + ": is a light file, and suns are found in images");
    const Stopwatch stopwatch;
    const LoadedLight light = load_light(a.environment, a.order, a.suns, a.light_options, a.threads);
    const SunSplit& split = light.split;
    const double seconds = stopwatch.seconds();
    Json file = light_json(light.sky);
    if (separate)
        file["suns"] = suns_json(split);
    session.write(a.output, json_text(file));

    const glm::vec3 mean = light.sky.coefficients[0] * static_cast<float>(kY00);
    Report report;
    add_figures(report, {{"output", a.output.string()},
                         {"order", a.order},
                         {"mean_radiance", {mean.r, mean.g, mean.b}},
                         {"seconds", seconds}});
    report.sentences = {"{output}: order {order}, mean radiance {mean_radiance/0:.4g} {mean_radiance/1:.4g} "
                        "{mean_radiance/2:.4g}"};
    if (separate)
        report_suns(split, report);
    if (light.environment) {
        add_figures(report, {{"layout", layout_name(light.environment->layout)},
                             {"width_pixels", light.environment->image.width},
                             {"height_pixels", light.environment->image.height}});
        report.sentences.emplace_back("from a {layout} image of {width_pixels} x {height_pixels}");
    }
    publish(report, a.json, session);
}

} // namespace

void add_project(CLI::App& app, Session& session) {
    CLI::App* command =
        app.add_subcommand("project", "Project an environment map to SH coefficients and suns");
    auto& a = arguments_for<ProjectArguments>(
        command, [&session](const ProjectArguments& given) { run(given, session); });
    command
        ->add_option("environment", a.environment,
                     "environment image (.exr, .hdr, .png, .jpg) or light file (.json)\n"
                     "                              light file: output of prt project, at least of the order "
                     "of --order\n"
                     "                              name with the text {face}, as sky_{face}.hdr: six sides "
                     "of a cube\n"
                     "                              files of the sides +x -x +y -y +z -z: px nx py ny pz nz "
                     "instead of\n"
                     "                              {face}, or PX NX PY NY PZ NZ, or posx negx posy negy "
                     "posz negz, or\n"
                     "                              +x -x +y -y +z -z, or right left top bottom front back")
        ->required()
        ->check(named);
    add_output(command, a.output, "write the light to this file, .json");
    command
        ->add_option("--order", a.order,
                     "SH order N of the light, 1 to 10: N² coefficients\n"
                     "at least the order of the models that it lights: that of prt bake --order\n"
                     "  for models without transfer: 6\n"
                     "light file as input: at most the order of that file")
        ->capture_default_str()
        ->check(CLI::Range(1, kMaxOrder));
    add_suns(command, a.suns,
             "number of suns that are written separately from the sky\n"
             "light file: only 0, which adds its suns to the sky",
             "0");
    add_light_options(command, a.light_options);
    add_threads(command, a.threads);
    add_json(command, a.json);
}

} // namespace prt::cli

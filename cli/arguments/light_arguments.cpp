// Adds options for lights.

#include "cli/arguments/light_arguments.h"

#include "cli/arguments/options.h"
#include "cli/arguments/suboptions.h"
#include "cli/program/session.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::cli {
namespace {

constexpr Choice<Window> kWindows[] = {
    {"none", Window::none, "no filter"},
    {"hann", Window::hann, "Hann window: strong filter; also blurs light"},
    {"lanczos", Window::lanczos, "Lanczos window: weaker filter than hann"},
    {"auto", Window::automatic, "the weakest filter for which no radiance is negative"}};

/// Layout and center of an environment map.
struct MapLayout {
    EnvironmentLayout layout;
    LatLongCenter center = LatLongCenter::z;
};
constexpr Choice<MapLayout> kLayouts[] = {
    {"lat-long",
     {EnvironmentLayout::lat_long},
     "2:1, latitude and longitude; the center of the image shows direction +z (OpenEXR)"},
    {"lat-long-x",
     {EnvironmentLayout::lat_long, LatLongCenter::x},
     "the same, but the center shows +x (three.js, glTF viewers, Blender)"},
    {"cube",
     {EnvironmentLayout::cube},
     "six faces in a column; edge texels are centered on the edges of the cube (OpenEXR)"},
    {"cube-faces",
     {EnvironmentLayout::cube_faces},
     "six faces in a column, a row or a cross; no texel is shared by faces (OpenGL, Direct3D)"},
    {"angular",
     {EnvironmentLayout::angular},
     "light probe (Debevec): all directions in a circle; the center shows -z"}};
constexpr Choice<BadPixels> kBadPixels[] = {
    {"error", BadPixels::error, "stop with an error"},
    {"zero", BadPixels::zero, "replace the pixel by black"},
    {"clamp", BadPixels::clamp,
     "set negative channels and NaN to 0, infinite ones to the largest value of the image"}};
constexpr Choice<MetricChoice> kMetrics[] = {
    {"outdoor", MetricChoice::outdoor, "built-in family: skies with ground and sun"},
    {"indoor", MetricChoice::indoor, "built-in family: rooms with windows and lamps"},
    {"day", MetricChoice::day, "built-in family: clear skies from morning to evening"},
    {"natural", MetricChoice::natural, "built-in family: natural light, rotated to all orientations"},
    {"plain", MetricChoice::plain, "no lights: all SH coefficients of the transfer have the same weight"}};

void set_count(const std::string& text, SunCount& suns) {
    suns.count = text == "auto" ? std::nullopt : whole_number(text);
    if (text != "auto" && (!suns.count || *suns.count < 0 || *suns.count > 16))
        throw CLI::ValidationError("--suns", "'" + text + "' is neither auto nor a number in 0..16");
}

} // namespace

CLI::Option* add_lights(CLI::App* command, std::vector<Path>& lights, const std::string& text) {
    return command
        ->add_option("--lights", lights, text + "\n" + kLightFiles + "\nrepeat the option for several files")
        ->allow_extra_args(false) // one each time, so that positional arguments may follow
        ->check(named)
        ->type_name("FILE");
}

CLI::Option* add_light(CLI::App* command, Path& light) {
    return command
        ->add_option(
            "--lights", light,
            std::string(
                "sky and suns that light the model\n"
                "prt relight of a model without baked lamps needs --lights\n"
                "light file: at least the order of the model; render without transfer: at least 6\n") +
                kLightFiles)
        ->check(named)
        ->type_name("FILE")
        ->default_str("black sky, only lamps");
}

void add_light_options(CLI::App* command, LightOptions& options) {
    options.notify = print_notices;
    const auto window = std::ranges::find(kWindows, options.window, &Choice<Window>::value);
    choice(command, "--window", options.window, kWindows,
           "filter on the SH bands of the sky against ringing\n"
           "needs a light from a file; separate suns are not filtered",
           window->name);
    command
        ->add_option("--rotate", options.rotation_degrees,
                     "rotate the sky and its suns about +Y by X degrees\n"
                     "counter-clockwise, seen from above; needs a light from a file")
        ->capture_default_str()
        ->check(real_in(-1e6, 1e6));
    command
        ->add_option_function<std::string>(
            "--env-layout",
            [&options](const std::string& name) {
                const MapLayout layout = chosen("--env-layout", kLayouts, name);
                options.environment.layout = layout.layout;
                options.environment.center = layout.center;
            },
            "arrangement of directions in the image\n"
            "default: the attribute of an OpenEXR file; else by width:height, 2:1: lat-long, 1:6: cube,\n"
            "  cross, row, or six files sky_{face}.hdr with px, nx, py, ny, pz, nz: cube-faces\n"
            "  other images need this option; light files ignore it" +
                explained(kLayouts))
        ->type_name("LAYOUT")
        ->default_str("by the file");
    command
        ->add_option(
            "--layer", options.environment.layer,
            "name of the layer or part of an OpenEXR image to read\n"
            "default: the channels without a layer name, else the only layer; other formats: an error")
        ->default_str("by the file");
    choice(command, "--bad-pixels", options.environment.bad_pixels, kBadPixels,
           "handling of negative, infinite and NaN pixels of an image", "error");
}

void check_light_options(const CLI::App& command, bool has_lights) {
    for (const char* name : {"--rotate", "--window", "--env-layout", "--layer", "--bad-pixels"})
        if (!has_lights && command.count(name) > 0)
            throw CLI::ValidationError(name, "needs --lights FILE");
}

void add_suns(CLI::App* command, SunCount& suns, const std::string& text, const std::string& usual,
              int* rays) {
    Suboptions option("--suns", "N|auto", text,
                      [&suns](const std::string& given) { set_count(given, suns); });
    option.detail("N: at most the N strongest suns of an image, 0 to 16; 0: suns are part of the sky")
        .detail("auto: up to 4 suns of an image; each reduces the error in shadows by 0.01 (1 %) or more");
    if (rays)
        option.whole_number("rays", 1, 1 << 20,
                            fmt::format("rays to each sun, from a vertex (relight) or a pixel (render) [{}]\n"
                                        "  1 to 2^20; render on a GPU ignores it and draws shadow maps",
                                        *rays),
                            [rays](int count) { *rays = count; });
    option.add(command)->default_str(usual);
}

void add_lamps(CLI::App* command, LampChoice& lamps) {
    command
        ->add_option_function<std::string>(
            "--lamp-strengths",
            [&lamps](const std::string& given) {
                lamps.on = given != "off";
                lamps.file = given == "on" || given == "off" ? "" : given;
            },
            "brightness of the baked lamps\n"
            "on: the strengths of the scene\n"
            "off: all lamps are dark\n"
            "FILE: .json with a factor or [red, green, blue] for each lamp name; \"*\": all other lamps\n"
            "factors: 0 to 1e9, multiply the strengths of the scene; lamps that are not listed: 1\n"
            "name: of a light, emissive material or group of prt bake; other names are an error")
        ->type_name("on|off|FILE")
        ->default_str("on");
}

void add_lamp_scale(CLI::App* command, double& scale, const std::string& details) {
    command
        ->add_option(
            "--lamp-scale", scale,
            "factor on the intensity of point, spot and directional lights\n"
            "X: above 0; 1 for lights in watts, 0.00146 (1/683) for lights in candela and lux\n"
            "candela and lux are the units of the glTF standard; Blender, for example, exports them\n"
            "emissive materials are not scaled" +
                details)
        ->capture_default_str()
        ->check(above_zero());
}

void add_metric(CLI::App* command, MetricArguments& arguments) {
    command
        ->add_option_function<std::vector<std::string>>(
            "--lights",
            [&arguments](const std::vector<std::string>& names) {
                for (const std::string& name : names) {
                    const auto family = std::ranges::find(kMetrics, name, &Choice<MetricChoice>::name);
                    if (family == std::end(kMetrics))
                        arguments.lights.emplace_back(name);
                    else if (names.size() > 1)
                        throw CLI::ValidationError("--lights",
                                                   "'" + name + "' cannot be combined with others");
                    else
                        arguments.metric = family->value;
                }
            },
            "lights under which the error is minimized" + explained(kMetrics) + "\n" + kLightFiles +
                "\nrepeat the option for several files; a family cannot be combined with other lights")
        ->allow_extra_args(false) // one each time, so that the bake may follow
        ->check(named)
        ->type_name("FAMILY|FILE")
        ->default_str("outdoor");
    add_light_options(command, arguments.light_options);
}

} // namespace prt::cli

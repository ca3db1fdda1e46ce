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
    {"auto", Window::automatic, "the weakest filter for which no radiance of the sky is negative"}};

/// Layout and center of an environment map.
struct MapLayout {
    EnvironmentLayout layout;
    LatLongCenter center = LatLongCenter::z;
};
constexpr Choice<MapLayout> kLayouts[] = {
    {"lat-long",
     {EnvironmentLayout::lat_long},
     "latitude and longitude, usually 2:1; the center of the image shows +z (OpenEXR)"},
    {"lat-long-x",
     {EnvironmentLayout::lat_long, LatLongCenter::x},
     "the same, but the center shows +x (three.js, glTF viewers, Blender)"},
    {"cube",
     {EnvironmentLayout::cube},
     "faces +x -x +y -y +z -z in a column; edge texels are centered on cube edges (OpenEXR)"},
    {"cube-faces",
     {EnvironmentLayout::cube_faces},
     "these faces in a column, row or cross; faces share no texels (OpenGL, Direct3D)\n"
     "  a cross must have one color outside the faces, also with this option"},
    {"angular",
     {EnvironmentLayout::angular},
     "1:1, light probe (Debevec): all directions in a circle; the center shows -z"}};
constexpr Choice<BadPixels> kBadPixels[] = {
    {"error", BadPixels::error, "stop with an error"},
    {"zero", BadPixels::zero, "replace the pixel by black, all three channels"},
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

/// Adds options for reading images.
void add_image_options(CLI::App* command, EnvironmentOptions& options) {
    command
        ->add_option_function<std::string>(
            "--env-layout",
            [&options](const std::string& name) {
                const MapLayout layout = chosen("--env-layout", kLayouts, name);
                options.layout = layout.layout;
                options.center = layout.center;
            },
            "arrangement of directions in the environment image\n"
            "default: the attribute of an OpenEXR file; else by width:height, 2:1: lat-long, 1:6: cube,\n"
            "  6:1 (row), and 4:3 or 3:4 (cross) with one color outside the faces: cube-faces\n"
            "  other images need this option\n"
            "six files: the name sky_{face}.hdr reads sky_px.hdr, sky_nx.hdr, and py, ny, pz, nz\n"
            "  or PX NX PY NY PZ NZ, or posx negx posy negy posz negz, or +x -x +y -y +z -z, or\n"
            "  right left top bottom front back; default: cube-faces\n"
            "needs a light from a file; no effect on light files (.json)" +
                explained(kLayouts))
        ->type_name("LAYOUT")
        ->default_str("by the file");
    command
        ->add_option(
            "--layer", options.layer,
            "name of the layer or part of an OpenEXR image to read\n"
            "layer: the channels NAME.R, NAME.G and NAME.B, or NAME.Y\n"
            "part: the channels R, G and B, or Y, of the part with this name\n"
            "default: the channels without a layer name in the first part, else the only layer or part\n"
            "  other OpenEXR images need this option\n"
            "other image formats: an error; light files ignore it; needs a light from a file")
        ->default_str("by the file");
    choice(command, "--bad-pixels", options.bad_pixels, kBadPixels,
           "handling of negative, infinite and NaN pixels of an image\n"
           "needs a light from a file; light files ignore it",
           "error");
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
                "no effect on prt render --show clusters and ao\n"
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
           "needs a light from a file; suns in the sky are filtered, separate suns are not\n"
           "images are not filtered where they are the background or the light of path tracing",
           window->name);
    command
        ->add_option("--rotate", options.rotation_degrees,
                     "rotate the sky and its suns about +Y by X degrees\n"
                     "X above 0: counter-clockwise, seen from above; -1000000 to 1000000\n"
                     "prt compress: affects only --fallback; errors are minimized over all rotations\n"
                     "needs a light from a file: image or light file")
        ->capture_default_str()
        ->check(real_in(-1e6, 1e6));
    add_image_options(command, options.environment);
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
        .detail(
            "auto: 0 to 4 suns of an image, if they reduce the relative error in shadows by 0.01 per sun");
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
            "a model without transfer has no lamps, except with prt render --path-trace\n"
            "on: the strengths with which they were baked\n"
            "off: all lamps are dark\n"
            "FILE: .json with a factor or [red, green, blue] for each lamp name; \"*\": all other lamps\n"
            "  as {\"desk\": 0.5, \"*\": [1, 0.9, 0.8]}; without \"*\", lamps that are not listed have 1\n"
            "factors: 0 to 1e9, multiply the baked strengths\n"
            "name: of the node of a light (if it has none, of the light), of an emissive material, or of\n"
            "  a group of prt bake --lamps (not of its members); prt info --json lists the names\n"
            "  other names are an error")
        ->type_name("on|off|FILE")
        ->default_str("on");
}

void add_lamp_scale(CLI::App* command, double& scale, const std::string& details) {
    command
        ->add_option(
            "--lamp-scale", scale,
            "factor on the intensity of point, spot and directional lights\n"
            "X: above 0; 1 for lights in W/sr and W/m², 0.00146 (1/683) for lights in candela and lux\n"
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
                "\nlight file: at least of the order of the bake; repeat the option for several files\n"
                "a family cannot be combined with other lights\n"
                "outdoor, indoor, day and FILE: mean of all rotations about +Y\n"
                "suns of the lights: in the sky, and also separate (without their direct light)\n"
                "  FILE and natural: separate if the result has direct and indirect transfer\n"
                "  outdoor, indoor and day: separate if it has direct transfer\n"
                "with every FAMILY and FILE, the error of the lamps of the bake is also minimized")
        ->allow_extra_args(false) // one each time, so that the bake may follow
        ->check(named)
        ->type_name("FAMILY|FILE")
        ->default_str("outdoor");
    add_light_options(command, arguments.light_options);
}

} // namespace prt::cli

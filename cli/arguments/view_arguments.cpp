// Parses camera and exposure options.

#include "cli/arguments/view_arguments.h"

#include "cli/arguments/options.h"

#include <glm/trigonometric.hpp>

#include <cmath>
#include <cstdio>

namespace prt::cli {
namespace {

void parse_vector(const std::string& name, const std::string& text, std::optional<glm::dvec3>& target) {
    glm::dvec3 v(0);
    int used = 0;
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &v.x, &v.y, &v.z, &used) != 3 ||
        static_cast<std::size_t>(used) != text.size() || !std::isfinite(v.x + v.y + v.z))
        throw CLI::ValidationError(name, "'" + text + "' is not x,y,z, three finite numbers");
    target = v;
}

void vector_option(CLI::App* command, const std::string& name, std::optional<glm::dvec3>& target,
                   const std::string& text, const std::string& usual) {
    command
        ->add_option_function<std::string>(
            name, [name, &target](const std::string& value) { parse_vector(name, value, target); }, text)
        ->type_name("x,y,z")
        ->default_str(usual);
}

void parse_size(const std::string& text, int& width, int& height) {
    constexpr int kMax = 16384;
    int used = 0;
    if (std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used) != 2 ||
        static_cast<std::size_t>(used) != text.size() || width < 1 || height < 1 || width > kMax ||
        height > kMax)
        throw CLI::ValidationError("--size", "'" + text + "' is not WIDTHxHEIGHT in 1..16384");
}

constexpr double kMaxStops = 100; ///< floats go from -126 to 127

Exposure parse_exposure(const std::string& text) {
    Exposure exposure;
    exposure.automatic = text.starts_with("auto");
    const std::string number = exposure.automatic ? text.substr(4) : text;
    const bool sign_follows = number.empty() || number[0] == '+' || number[0] == '-';
    const std::optional<double> stops = number.empty() ? exposure.stops : real_number(number);
    if ((exposure.automatic && !sign_follows) || text.empty() || !stops || !(std::abs(*stops) <= kMaxStops))
        throw CLI::ValidationError("--exposure", "'" + text +
                                                     "' is neither a number of stops in -100..100 nor auto, "
                                                     "auto+STOPS or auto-STOPS");
    exposure.stops = *stops;
    return exposure;
}

} // namespace

void add_view(CLI::App* command, View& view) {
    command
        ->add_option_function<std::string>(
            "--size", [&view](const std::string& text) { parse_size(text, view.width, view.height); },
            "width and height of the picture in pixels, 1 to 16384 each")
        ->type_name("WxH")
        ->default_str("1280x720");
    vector_option(command, "--camera", view.camera,
                  "position of the camera in the scene, metres\n"
                  "+Y is up; the camera must not look straight up or down\n"
                  "default: the whole scene is visible with --fov, --size and the default of --look-at\n"
                  "  a given --look-at rotates this camera, but does not move it",
                  "automatic");
    vector_option(command, "--look-at", view.look_at,
                  "point that the camera looks at, metres\n"
                  "not the position of the camera, and not straight above or below it\n"
                  "default: the point that centers the scene in the picture of the default --camera",
                  "near the center of the scene");
    command
        ->add_option("--fov", view.field_of_view_degrees,
                     "vertical field of view of the camera in degrees, 1 to 170")
        ->capture_default_str()
        ->check(real_in(1, 170));
}

CLI::Option* add_exposure(CLI::App* command, Exposure& exposure) {
    return command
        ->add_option_function<std::string>(
            "--exposure", [&exposure](const std::string& text) { exposure = parse_exposure(text); },
            "exposure in stops, or auto, auto+1, auto-0.5\n"
            "STOPS: radiance is multiplied by 2^STOPS; 0: unchanged; -100 to 100\n"
            "auto: the mean luminance of the model becomes 0.22; in prt render, of its visible part\n"
            "auto+1: one stop brighter than auto, a factor of 2\n"
            "needs --colors unlit (prt relight), or a .png picture with --show lit (prt render)")
        ->type_name("STOPS")
        ->default_str("auto");
}

} // namespace prt::cli

// Adds the options that several commands share.

#include "options.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace prt::cli {
namespace {

const std::map<std::string, Backend> kBackends = {
    {"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"gpu", Backend::gpu}};
const std::map<std::string, Inside> kInsides = {{"refill", Inside::refill}, {"keep", Inside::keep}};
const std::map<std::string, FitMode> kFits = {
    {"auto", FitMode::automatic}, {"vertex", FitMode::vertex}, {"surface", FitMode::surface}};
const std::map<std::string, BadTextures> kBadTextures = {{"error", BadTextures::error},
                                                         {"ignore", BadTextures::ignore}};
const std::map<std::string, Window> kWindows = {{"none", Window::none},
                                                {"hann", Window::hann},
                                                {"lanczos", Window::lanczos},
                                                {"auto", Window::automatic}};
const std::map<std::string, EnvironmentLayout> kLayouts = {{"lat-long", EnvironmentLayout::lat_long},
                                                           {"cube", EnvironmentLayout::cube},
                                                           {"cube-faces", EnvironmentLayout::cube_faces},
                                                           {"angular", EnvironmentLayout::angular}};
const std::map<std::string, LatLongCenter> kCenters = {{"x", LatLongCenter::x}, {"z", LatLongCenter::z}};
const std::map<std::string, BadPixels> kBadPixels = {
    {"error", BadPixels::error}, {"zero", BadPixels::zero}, {"clamp", BadPixels::clamp}};

} // namespace

CLI::Validator real_in(double low, double high) {
    const std::string range = fmt::format("[{} - {}]", low, high);
    const auto check = [low, high, range](const std::string& text) {
        const std::optional<double> value = real_number(text);
        return value && *value >= low && *value <= high ? std::string() : text + " is no number in " + range;
    };
    return {check, "FLOAT in " + range};
}

CLI::Validator above_zero() {
    const auto check = [](const std::string& text) {
        const std::optional<double> value = real_number(text);
        return value && *value > 0 && std::isfinite(*value) ? std::string()
                                                            : text + " is no finite number above 0";
    };
    return {check, "POSITIVE"};
}

CLI::Validator seed() {
    const auto check = [](const std::string& text) {
        std::uint64_t value = 0;
        const char* end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        return error == std::errc() && stop == end ? std::string()
                                                   : text + " is no whole number in [0 - 2^64 - 1]";
    };
    return {check, "UINT64"};
}

std::string named(const std::string& name) {
    return name.empty() ? "the name of the file is empty" : "";
}

void add_output(CLI::App* command, Path& output, const std::string& text) {
    command->add_option("-o,--output", output, text)->required()->type_name("FILE")->check(named);
}

void add_reading(CLI::App* command, ReadingOptions& reading) {
    command->add_flag("--allow-outside", reading.allow_outside,
                      "a scene's buffers and images may lie outside its folder: for scenes that you trust");
    choice(command, "--bad-textures", reading.bad_textures, kBadTextures,
           "textures that are missing, damaged or of a format that is not read: stop where one is needed, or "
           "use the factors of their materials alone, and no emission where its texture is one",
           "error");
    command
        ->add_option_function<double>(
            "--scene-limit", [&reading](double gigabytes) { reading.scene_limit = 1e9 * gigabytes; },
            "GB that a scene may take with its instances and morph targets; otherwise 0.256 and 64 times the "
            "size of its files")
        ->check(above_zero());
}

void add_smooth_normals(CLI::App* command, GltfOptions& reading) {
    command
        ->add_option("--smooth-normals", reading.smooth_normals_degrees,
                     "primitives without normals get smooth ones across edges of this angle or less; without "
                     "it flat ones")
        ->type_name("DEGREES")
        ->check(CLI::Range(0.0, 180.0));
}

void add_threads(CLI::App* command, int& threads) {
    command->add_option("--threads", threads, "number of threads, 0: all")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
}

void add_json(CLI::App* command, Path& json) {
    command->add_option("--json", json, "also write all figures to this file")
        ->type_name("FILE")
        ->check(named);
}

void add_reports(CLI::App* command, ReportFiles& files) {
    add_json(command, files.json);
    command->add_option("--html", files.html, "also write a report page to this file")
        ->type_name("FILE")
        ->check(named);
    command
        ->add_option("--csv", files.csv,
                     "also write all tables to this file: one row per method, budget, light or lamp, units "
                     "in the header")
        ->type_name("FILE")
        ->check(named);
}

CLI::Option* add_gpu(CLI::App* command, std::string& gpu) {
    return command
        ->add_option("--gpu", gpu,
                     "the GPU to bake on: its number, or a part of its name (bench --list-devices)")
        ->type_name("N|NAME")
        ->check([](const std::string& name) { return name.empty() ? "the name is empty" : ""; });
}

CLI::Option* add_backend(CLI::App* command, Backend& backend, const std::string& text) {
    return choice(command, "--backend", backend, kBackends, text, "auto");
}

void choose_gpu(TracerChoice& tracer) {
    if (tracer.gpu.empty())
        return;
    if (tracer.backend == Backend::cpu)
        throw Error("--gpu names a GPU, and --backend cpu uses none");
    if (tracer.method == BakeMethod::raster)
        throw Error("--gpu names a GPU for rays: depth maps are drawn where OpenGL is");
    tracer.backend = Backend::gpu;
}

void add_inside(CLI::App* command, Inside& inside) {
    choice(command, "--inside", inside, kInsides,
           "vertices that lie inside solid geometry, where no light comes: they take the light of their "
           "neighbours, or stay dark",
           "refill");
}

void add_fit(CLI::App* command, FitMode& fit, const std::string& text) {
    fit = FitMode::automatic;
    choice(command, "--fit", fit, kFits, text, "auto");
}

void add_light_options(CLI::App* command, LightOptions& options) {
    const auto window = std::find_if(kWindows.begin(), kWindows.end(),
                                     [&](const auto& named) { return named.second == options.window; });
    choice(command, "--window", options.window, kWindows,
           "filter of the SH bands against ringing; auto: the least under which no radiance is negative",
           window->first);
    command
        ->add_option("--rotate", options.rotation_degrees,
                     "turn the environment about +Y, degrees, counter-clockwise from above")
        ->capture_default_str()
        ->check(real_in(-1e6, 1e6));
    choice(command, "--env-layout", options.environment.layout, kLayouts,
           "how to read an image that does not say; otherwise by its shape", "by shape");
    command->add_option(
        "--layer", options.environment.layer,
        "layer or part of an OpenEXR environment; otherwise its plain channels or its only layer");
    choice(
        command, "--env-center", options.environment.center, kCenters,
        "what the centre column of a lat-long image looks at: z as OpenEXR says, x as three.js, glTF viewers "
        "and Blender show it",
        "z");
    choice(command, "--bad-pixels", options.environment.bad_pixels, kBadPixels,
           "what to do with negative, infinite and NaN pixels", "error");
}

std::optional<int> whole_number(const std::string& text) {
    char* end = nullptr;
    const long long value = std::strtoll(text.c_str(), &end, 0);
    const bool whole = !text.empty() && end == text.c_str() + text.size();
    return whole && value == static_cast<int>(value) ? std::optional(static_cast<int>(value)) : std::nullopt;
}

std::optional<double> real_number(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return !text.empty() && end == text.c_str() + text.size() ? std::optional(value) : std::nullopt;
}

} // namespace prt::cli

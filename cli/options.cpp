// Adds the options that several commands share.

#include "options.h"

#include "outputs.h"
#include "suboptions.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace prt::cli {
namespace {

constexpr Choice<Traversal> kTraversals[] = {
    {"auto", Traversal::automatic, "ray queries if the GPU has them, else compute"},
    {"compute", Traversal::compute, "a bounding volume hierarchy in compute shaders"},
    {"device", Traversal::device, "ray queries of the GPU"}};
constexpr Choice<Inside> kInsides[] = {{"refill", Inside::refill, "they get the light of their neighbours"},
                                       {"keep", Inside::keep, "they stay dark"}};
constexpr Choice<FitMode> kFits[] = {
    {"auto", FitMode::automatic,
     "surface if test points between the vertices show a smaller error, else vertex"},
    {"vertex", FitMode::vertex, "at the vertices"},
    {"surface", FitMode::surface, "over the surface; vertex values are a least-squares fit"}};
constexpr Choice<BadTextures> kBadTextures[] = {
    {"error", BadTextures::error, "stop if the command needs the texture"},
    {"ignore", BadTextures::ignore,
     "use the factors of the material; no emission if its texture is unusable"}};
constexpr Choice<Window> kWindows[] = {
    {"none", Window::none, "no filter"},
    {"hann", Window::hann, "Hann window"},
    {"lanczos", Window::lanczos, "Lanczos window"},
    {"auto", Window::automatic, "the weakest filter for which no radiance is negative"}};

/// Layout and center of an environment map.
struct MapLayout {
    EnvironmentLayout layout;
    LatLongCenter center = LatLongCenter::z;
};
constexpr Choice<MapLayout> kLayouts[] = {
    {"lat-long", {EnvironmentLayout::lat_long}, "the center looks along z (OpenEXR); default of 2:1 images"},
    {"lat-long-x",
     {EnvironmentLayout::lat_long, LatLongCenter::x},
     "the center looks along x, as in three.js, glTF viewers and Blender"},
    {"cube",
     {EnvironmentLayout::cube},
     "six faces in a column, edge texels on the edges of the cube (OpenEXR)"},
    {"cube-faces",
     {EnvironmentLayout::cube_faces},
     "six faces in a row or a cross (OpenGL, Vulkan, Direct3D)"},
    {"angular", {EnvironmentLayout::angular}, "light probe: all directions in a circle (Debevec)"}};
constexpr Choice<BadPixels> kBadPixels[] = {
    {"error", BadPixels::error, "stop"},
    {"zero", BadPixels::zero, "set them to 0"},
    {"clamp", BadPixels::clamp, "limit them to 0 .. the largest valid value; NaN becomes 0"}};

CLI::Validator seed_range() {
    const auto check = [](const std::string& text) {
        std::uint64_t value = 0;
        const char* end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        return error == std::errc() && stop == end ? std::string()
                                                   : text + " is not a whole number in [0 - 2^64 - 1]";
    };
    return {check, "UINT64"};
}

void set_device(const std::string& text, TracerChoice& tracer) {
    tracer.gpu.clear();
    if (text.empty())
        throw CLI::ValidationError("--device", "the name is empty");
    if (text == "auto" || text == "cpu" || text == "gpu") {
        tracer.backend = text == "auto" ? Backend::automatic : text == "cpu" ? Backend::cpu : Backend::gpu;
        return;
    }
    tracer.backend = Backend::gpu;
    tracer.gpu = text;
}

} // namespace

CLI::Validator real_in(double low, double high) {
    const std::string range = fmt::format("[{} - {}]", low, high);
    const auto check = [low, high, range](const std::string& text) {
        const std::optional<double> value = real_number(text);
        return value && *value >= low && *value <= high ? std::string()
                                                        : text + " is not a number in " + range;
    };
    return {check, "FLOAT in " + range};
}

CLI::Validator above_zero() {
    const auto check = [](const std::string& text) {
        const std::optional<double> value = real_number(text);
        return value && *value > 0 && std::isfinite(*value) ? std::string()
                                                            : text + " is not a finite number above 0";
    };
    return {check, "POSITIVE"};
}

std::string named(const std::string& name) {
    return name.empty() ? "the name of the file is empty" : "";
}

void add_output(CLI::App* command, Path& output, const std::string& text) {
    command->add_option("-o,--output", output, text)->required()->type_name("FILE")->check(named);
}

void add_reading(CLI::App* command, ReadingOptions& reading, double* limit) {
    command->add_flag("--allow-outside", reading.allow_outside,
                      "allow files outside the scene's folder; for trusted scenes");
    choice(command, "--bad-textures", reading.bad_textures, kBadTextures,
           "handling of missing, damaged or unsupported textures", "error");
    command
        ->add_option_function<std::uint64_t>(
            "--memory-limit",
            [&reading, limit](const std::uint64_t& bytes) {
                if (bytes == 0 || bytes > std::uint64_t{1} << 60) // a negative number wraps to this range
                    throw CLI::ValidationError("--memory-limit", "expected a size above 0, for example 8GB");
                reading.scene_limit = static_cast<double>(bytes);
                if (limit)
                    *limit = static_cast<double>(bytes);
            },
            limit ? "memory limit for the bake and the scene, as 8GB" : "memory limit for the scene, as 8GB")
        ->transform(CLI::AsSizeValue(true))
        ->type_name("SIZE")
        ->default_str(limit ? "the machine's memory" : "256MB + 64 x file");
}

void add_smooth_normals(CLI::App* command, GltfOptions& reading) {
    command
        ->add_option("--smooth-normals", reading.smooth_normals_degrees,
                     "smooth normals across edges up to this angle, if normals are missing")
        ->type_name("DEGREES")
        ->check(real_in(0, 180));
}

void add_threads(CLI::App* command, int& threads) {
    command->add_option("--threads", threads, "number of threads; 0: all")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
}

void add_json(CLI::App* command, Path& json) {
    command->add_option("--json", json, "write all figures to this file")->type_name("FILE")->check(named);
}

void add_reports(CLI::App* command, ReportFiles& files) {
    add_json(command, files.json);
    command
        ->add_option_function<std::vector<std::string>>(
            "--report",
            [&files](const std::vector<std::string>& names) {
                for (const std::string& name : names) {
                    const std::string suffix = suffix_of(name);
                    if (suffix != ".html" && suffix != ".htm" && suffix != ".csv")
                        throw CLI::ValidationError("--report", "'" + name + "' is neither .html nor .csv");
                    Path& file = suffix == ".csv" ? files.csv : files.html;
                    if (!file.empty())
                        throw CLI::ValidationError("--report",
                                                   fmt::format("'{}' is a second {} file", name, suffix));
                    file = name;
                }
            },
            "write a page (.html) or tables (.csv); repeat the option for both\n"
            ".csv: one table; a row is a light, a lamp, a method or a trial; units are in the header")
        ->allow_extra_args(false)
        ->type_name("FILE");
}

CLI::Option* add_device(CLI::App* command, TracerChoice& tracer) {
    return Suboptions("--device", "auto|cpu|gpu|N|NAME", "processor that traces the rays",
                      [&tracer](const std::string& text) { set_device(text, tracer); })
        .detail("auto: a hardware GPU if there is one, else the CPU")
        .detail("cpu: Embree")
        .detail("gpu: Vulkan 1.2, hardware or software")
        .detail("N, NAME: a GPU by its number or part of its name, from bench --device list")
        .key("traversal", names_of(kTraversals), "ray queries of the GPU (device) or compute shaders",
             [&tracer](const std::string& name) { tracer.traversal = chosen("--device", kTraversals, name); })
        .add(command)
        ->default_str("auto");
}

void check_device(const TracerChoice& tracer) {
    if (!tracer.gpu.empty() && tracer.method == BakeMethod::raster)
        throw Error("--device names a GPU for rays, but --method raster draws on the GPU of OpenGL; use "
                    "--device gpu");
}

void add_seed(CLI::App* command, std::uint64_t& seed) {
    command->add_option("--seed", seed, "seed of the random numbers")
        ->capture_default_str()
        ->check(seed_range());
}

void add_enclosed(CLI::App* command, Inside& inside) {
    choice(command, "--enclosed", inside, kInsides, "receivers inside solid geometry", "refill");
}

CLI::Option* add_lights(CLI::App* command, std::vector<Path>& lights, const std::string& text) {
    return command->add_option("--lights", lights, text + "\n" + kLightFiles + "; repeat the option for each")
        ->allow_extra_args(false) // one each time, so that positional arguments may follow
        ->check(named)
        ->type_name("FILE");
}

CLI::Option* add_light(CLI::App* command, Path& light) {
    return command->add_option("--lights", light, std::string("light of the sky\n") + kLightFiles)
        ->check(named)
        ->type_name("FILE")
        ->default_str("lamps only");
}

void add_fit(CLI::App* command, FitMode& fit, const std::string& text) {
    fit = FitMode::automatic;
    choice(command, "--fit", fit, kFits, text, "auto");
}

void add_light_options(CLI::App* command, LightOptions& options) {
    const auto window = std::ranges::find(kWindows, options.window, &Choice<Window>::value);
    choice(command, "--window", options.window, kWindows, "filter of the SH bands against ringing",
           window->name);
    command
        ->add_option("--rotate", options.rotation_degrees,
                     "rotate the environment about +Y, degrees\ncounter-clockwise, seen from above")
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
            "layout of the image" + explained(kLayouts))
        ->type_name(names_of(kLayouts))
        ->default_str("attribute or shape");
    command->add_option("--layer", options.environment.layer, "layer or part of an OpenEXR environment")
        ->default_str("RGB or the only layer");
    choice(command, "--bad-pixels", options.environment.bad_pixels, kBadPixels,
           "handling of negative, infinite and NaN pixels", "error");
}

void check_light_options(const CLI::App& command, bool has_lights) {
    for (const char* name : {"--rotate", "--window", "--env-layout", "--layer", "--bad-pixels"})
        if (!has_lights && command.count(name) > 0)
            throw CLI::ValidationError(name, "needs --lights FILE");
}

std::optional<int> whole_number(const std::string& text) {
    char* end = nullptr;
    const long long value = std::strtoll(text.c_str(), &end, 10);
    const bool whole = !text.empty() && end == text.c_str() + text.size();
    return whole && value == static_cast<int>(value) ? std::optional(static_cast<int>(value)) : std::nullopt;
}

std::optional<double> real_number(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return !text.empty() && end == text.c_str() + text.size() ? std::optional(value) : std::nullopt;
}

} // namespace prt::cli

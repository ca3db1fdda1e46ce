// Adds the options that several commands share.

#include "cli/arguments/options.h"

#include "cli/arguments/suboptions.h"
#include "cli/pipeline/model.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace prt::cli {
namespace {

constexpr Choice<Traversal> kTraversals[] = {
    {"auto", Traversal::automatic, "device if the GPU has ray queries, else compute"},
    {"compute", Traversal::compute, "a bounding volume hierarchy in compute shaders"},
    {"device", Traversal::device, "ray queries of the GPU"}};
constexpr Choice<Inside> kInsides[] = {
    {"refill", Inside::refill,
     "the value of their neighbours; avoids dark seams where solids meet\n"
     "  vertices remain black if their part of the mesh is completely inside"},
    {"keep", Inside::keep, "black, because no light reaches them"}};
constexpr Choice<FitMode> kFits[] = {
    {"auto", FitMode::automatic,
     "surface if its error at test points between the vertices is smaller, else vertex"},
    {"vertex", FitMode::vertex, "at the position of each vertex"},
    {"surface", FitMode::surface,
     "at random points of the triangles; vertex values are a least-squares fit to them"}};
constexpr Choice<BadTextures> kBadTextures[] = {
    {"error", BadTextures::error, "stop with an error if the command needs the texture"},
    {"ignore", BadTextures::ignore,
     "use the factors of the material alone; no emission if the emissive texture is bad"}};

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
    reading.notify = print_notices;
    command->add_flag("--allow-outside", reading.allow_outside,
                      "let scenes read files outside their folders; for trusted scenes only\n"
                      "scenes: all .gltf and .glb inputs; files: buffers and textures\n"
                      "folder: that of the scene that names the file; a link counts as its target\n"
                      "default: buffers outside are an error; textures outside are missing (--bad-textures)");
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
            limit ? "limit of memory for scene and bake, as 8GB\n"
                    "the program stops if one of them needs more\n"
                    "SIZE: a whole number above 0; 1 GB: 10^9 bytes, 1 GiB: 2^30 bytes; no unit: bytes\n"
                    "scene: geometry with all instances and morph targets, without textures\n"
                    "default for the bake: the memory of the machine, or of its container if smaller\n"
                    "default for the scene: 256 MB + 64 times the size of the .gltf or .glb and its buffers"
                  : "limit of memory for the scene, as 8GB\n"
                    "an error if more is needed; each scene or model that is read has this limit\n"
                    "SIZE: a whole number above 0; 1 GB: 10^9 bytes, 1 GiB: 2^30 bytes; no unit: bytes\n"
                    "scene: geometry with all instances and morph targets, without textures and transfer\n"
                    "file size: of the .gltf or .glb and its buffers")
        ->transform(CLI::AsSizeValue(true))
        ->type_name("SIZE")
        ->default_str(limit ? "the machine's memory" : "256MB + 64 x file size");
}

void add_smooth_normals(CLI::App* command, GltfOptions& reading) {
    command
        ->add_option("--smooth-normals", reading.smooth_normals_degrees,
                     "compute missing normals, smooth up to this edge angle; default: flat\n"
                     "angle between the normals of two adjacent triangles, 0 to 180\n"
                     "edges with a larger angle are sharp; existing normals are kept\n"
                     "flat: the normal of each triangle")
        ->type_name("DEGREES")
        ->check(real_in(0, 180));
}

void add_threads(CLI::App* command, int& threads) {
    command
        ->add_option("--threads", threads, "number of CPU threads, up to 1024; 0: all that the machine has")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
}

void add_json(CLI::App* command, Path& json) {
    command
        ->add_option(
            "--json", json,
            "write all results as JSON to this file, .json; default: no file\n"
            "results: the numbers that the command prints, and others; not the data of the output file")
        ->type_name("FILE")
        ->check(named);
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
            "write a report: a page (.html) or tables (.csv); default: no report\n"
            "repeat the option to write both files\n"
            ".csv: rows of tables and a summary; first column: name of the table; header: with units")
        ->allow_extra_args(false)
        ->type_name("FILE");
}

CLI::Option* add_device(CLI::App* command, TracerChoice& tracer) {
    return Suboptions("--device", "auto|cpu|gpu|N|NAME", "processor that traces the rays",
                      [&tracer](const std::string& text) { set_device(text, tracer); })
        .detail("auto: a hardware GPU with Vulkan 1.2 and enough memory if there is one, else the CPU")
        .detail("cpu: the CPU, with Embree")
        .detail("gpu: a GPU with Vulkan 1.2, else a software driver for Vulkan 1.2; if both lack: an error\n"
                "auto and gpu: of several GPUs, the one with the largest memory")
        .detail("N: the GPU with this number in the list of prt bench --device list")
        .detail(
            "NAME: the only GPU whose name in that list contains NAME; upper or lower case; else an error")
        .detail("prt bake --method raster: only auto and gpu, which then use OpenGL 4.5")
        .key("traversal", names_of(kTraversals), "how a GPU traces rays [auto]",
             [&tracer](const std::string& name) { tracer.traversal = chosen("--device", kTraversals, name); })
        .detail("  auto: device if the GPU has ray queries, else compute")
        .detail("  compute: a bounding volume hierarchy in compute shaders\n"
                "  device: ray queries of the GPU; if it has none: an error, with --device auto the CPU")
        .add(command)
        ->default_str("auto");
}

void check_device(const TracerChoice& tracer) {
    if (!tracer.gpu.empty() && tracer.method == BakeMethod::raster)
        throw Error("--device names a GPU for rays, but --method raster draws on the GPU of OpenGL; use "
                    "--device gpu");
}

void add_seed(CLI::App* command, std::uint64_t& seed) {
    command->add_option("--seed", seed, "seed of the random number generator, 0 to 2^64 - 1")
        ->capture_default_str()
        ->check(seed_range());
}

void add_enclosed(CLI::App* command, Inside& inside) {
    choice(command, "--enclosed", inside, kInsides,
           "value of vertices and texels inside solid geometry\n"
           "inside: all rays hit surfaces, at least 98 % of them the backs of single-sided materials\n"
           "prt ao: not with --occluders",
           "refill");
}

void add_fit(CLI::App* command, FitMode& fit, const std::string& text) {
    fit = FitMode::automatic;
    choice(command, "--fit", fit, kFits, text, "auto");
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

#pragma once

// What the command line says, as plain structs. Parsing is in the files named *arguments*.cpp and nowhere
// else.

#include "bench.h"
#include "prt/bake.h"
#include "prt/image_file.h"
#include "prt/light.h"
#include "prt/search.h"
#include "prt/shader_source.h"
#include "prt/tone_map.h"

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace prt::cli {

using Path = std::filesystem::path;

enum class Show { lit, clusters, error, ao };

/// How bright a picture is.
struct Exposure {
    bool automatic = true; ///< by what the model shows
    double stops = 0;      ///< of radiance, or beside the automatic ones
};

/// How every command reads lighting.
struct LightOptions {
    EnvironmentOptions environment;
    Window window = Window::none;
    double rotation_degrees = 0;
};

struct BakeArguments {
    Path scene, output, json;
    std::vector<std::string> no_shadow; ///< names of materials
    BakeOptions options;
};

struct BenchArguments {
    Path scene, json, html, csv;
    BenchOptions options;
    bool classic = false;
    std::string command_line;
};

enum class MetricChoice { natural, plain };

struct CompressArguments {
    Path baked, output, json;
    SearchOptions options; ///< without a budget `options.compress` says it all
    MetricChoice metric = MetricChoice::natural;
    std::vector<Path> lights; ///< to compress for, instead of `metric`
    LightOptions light_options;
    bool components_given = false;
    bool preset = false; ///< `options.compress` is one, to be fitted to the mesh
    bool best_effort = false;
    bool meshopt = false, reorder = false;
};

struct EvaluateArguments {
    Path baked, shipped, json, html, csv;
    std::vector<Path> lights;
    LightOptions light_options;
    int rotations = 1; ///< of each light about +Y
    bool sweep = false;
    std::string command_line;
    int threads = 0;
};

struct ProjectArguments {
    Path environment, output, json;
    int order = 6;
    int suns = 0; ///< lights to take out
    LightOptions light_options;
    int threads = 0;
};

struct RenderArguments {
    Path model, environment, output, json, baked;
    LightOptions light_options = {{}, Window::automatic, 0}; ///< a picture shows ringing as bruises
    int width = 1280, height = 720, samples = 2;
    std::optional<glm::dvec3> camera, look_at; ///< metres, world
    double field_of_view_degrees = 35;
    Backend backend = Backend::automatic;
    Show show = Show::lit;
    Exposure exposure;
    ToneMap tone_map = ToneMap::filmic;
    bool background = true;
    int threads = 0;
};

struct ShaderArguments {
    Path model, output;
    ShaderLanguage language = ShaderLanguage::glsl450;
    std::optional<ConstantSource> constants; ///< unset: what the language can do
    bool compute = false;
};

struct InfoArguments {
    Path file, json;
};

using Arguments = std::variant<BakeArguments, BenchArguments, CompressArguments, EvaluateArguments,
                               ProjectArguments, RenderArguments, ShaderArguments, InfoArguments>;

/// What was asked for, or the exit status when there is nothing to do: 0 after --help, 2 for wrong usage (a
/// line on stderr says what).
std::variant<Arguments, int> parse_arguments(int argc, char** argv);

} // namespace prt::cli

// Writes example scenes and skies into a folder.

#include "prt/image/image_file.h"
#include "sky_image.h"
#include "write_scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>
#include <span>
#include <string_view>

namespace {

struct NamedScene {
    std::string_view name;
    examples::ExampleScene (*make)();
    bool asked_for = false; ///< large, and only written if named
};

constexpr NamedScene kScenes[] = {{"knot", examples::torus_knot_over_plane},
                                  {"room", examples::room_with_columns},
                                  {"night_room", examples::night_room},
                                  {"courtyard", examples::courtyard},
                                  {"terrain", examples::terrain},
                                  {"tree", examples::tree},
                                  {"figure", examples::figure},
                                  {"plain_room", examples::plain_room, true},
                                  {"city", examples::city, true}};

/// Scenes with a number of objects given by the user: NAME:COUNT.
struct CountedScene {
    std::string_view name;
    examples::ExampleScene (*make)(int count);
    int usual; ///< default count
};

constexpr CountedScene kCountedScenes[] = {{"forest", examples::forest, 2000},
                                           {"street", examples::street, 40}};
constexpr int kMaxCounted = 100'000;

std::string_view bare_name(std::string_view argument) {
    return argument.substr(0, argument.find(':'));
}

/// Returns the number after the colon, 0 if it is not in 1 to kMaxCounted; `usual` without a colon.
int count_of(std::string_view argument, int usual) {
    const std::size_t colon = argument.find(':');
    if (colon == std::string_view::npos)
        return usual;
    int count = 0;
    const char* const end = argument.data() + argument.size();
    const auto [rest, error] = std::from_chars(argument.data() + colon + 1, end, count);
    return error == std::errc() && rest == end && count >= 1 && count <= kMaxCounted ? count : 0;
}

struct NamedSky {
    std::string_view name;
    prt::Environment (*make)();
};

const NamedSky kSkies[] = {
    {"noon", [] { return examples::sunny_sky(512, {.sun = glm::normalize(glm::dvec3(0.62, 0.9, 0.42))}); }},
    {"evening",
     [] {
         return examples::sunny_sky(512, {.sun = glm::normalize(glm::dvec3(0.9, 0.17, 0.5)),
                                          .turbidity = 3.5,
                                          .sun_to_sky = 1.8,
                                          .white = 0.3});
     }},
    {"night", [] { return examples::night_sky(512, glm::normalize(glm::dvec3(0.5, 0.8, 0.6))); }},
    {"sky", [] { return examples::preetham_sky(256, 3, glm::normalize(glm::dvec3(0.9, 0.75, 0.6))); }}};

bool is_known(std::string_view argument) {
    for (const CountedScene& scene : kCountedScenes)
        if (scene.name == bare_name(argument))
            return count_of(argument, scene.usual) > 0;
    const std::string_view name = argument;
    const auto is_named = [&](const auto& entry) { return entry.name == name; };
    return std::any_of(std::begin(kScenes), std::end(kScenes), is_named) ||
           std::any_of(std::begin(kSkies), std::end(kSkies), is_named);
}

/// Writes the named scenes and skies, or all that are written by default, and prints their paths.
void write(const std::filesystem::path& folder, std::span<char* const> names) {
    const auto is_wanted = [&](std::string_view name, bool asked_for) {
        return names.empty() ? !asked_for : std::find(names.begin(), names.end(), name) != names.end();
    };
    std::filesystem::create_directories(folder);
    const auto written = [&](std::string_view name, const char* suffix) {
        std::filesystem::path path = folder / (std::string(name) + suffix);
        std::printf("%s\n", path.c_str());
        return path;
    };
    for (const NamedScene& scene : kScenes)
        if (is_wanted(scene.name, scene.asked_for))
            examples::write_scene(scene.make(), written(scene.name, ".glb"));
    for (const CountedScene& scene : kCountedScenes)
        for (const std::string_view name : names)
            if (bare_name(name) == scene.name)
                examples::write_scene(scene.make(count_of(name, scene.usual)), written(scene.name, ".glb"));
    for (const NamedSky& sky : kSkies)
        if (is_wanted(sky.name, false))
            prt::write_exr(written(sky.name, ".exr"), sky.make().image, prt::EnvironmentLayout::lat_long);
}

void print_usage(std::FILE* to) {
    std::fprintf(to, "usage: example_scenes FOLDER [NAME...]\nWithout names: all scenes except city, forest "
                     "and street. Scenes:");
    for (const NamedScene& scene : kScenes)
        std::fprintf(to, " %s", scene.name.data());
    for (const CountedScene& scene : kCountedScenes)
        std::fprintf(to, " %s[:COUNT, default %d]", scene.name.data(), scene.usual);
    std::fprintf(to, "; skies:");
    for (const NamedSky& sky : kSkies)
        std::fprintf(to, " %s", sky.name.data());
    std::fprintf(to, "\n");
}

} // namespace

int main(int argc, char** argv) {
    const std::span<char* const> arguments(argv + 1, static_cast<std::size_t>(argc - 1));
    const bool help =
        argc == 2 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h");
    // A folder name that begins like an option is written as ./-name.
    if (help || arguments.empty() || arguments[0][0] == '-') {
        print_usage(help ? stdout : stderr);
        return help ? 0 : 2;
    }
    for (const char* name : arguments.subspan(1))
        if (!is_known(name)) {
            std::fprintf(stderr, "example_scenes: error: no scene or sky has the name %s\n", name);
            return 2;
        }
    try {
        write(arguments[0], arguments.subspan(1));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "example_scenes: error: %s\n", error.what());
        return 1;
    }
}

// prt-comparison: measures every way to light a scene against path tracing, and writes the page about it.

#include "report.h"

#include "prt/core/error.h"
#include "runtime/core/support/file.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace {

nlohmann::json json_of(const std::optional<double>& number) {
    return number ? nlohmann::json(*number) : nlohmann::json();
}

nlohmann::json json_of(const std::vector<comparison::SceneResult>& scenes,
                       const std::vector<comparison::Sky>& skies) {
    nlohmann::json json = nlohmann::json::array();
    for (const comparison::SceneResult& scene : scenes) {
        nlohmann::json rows = nlohmann::json::array();
        for (const comparison::Row& row : scene.rows) {
            nlohmann::json errors, flips;
            for (std::size_t i = 0; i < skies.size(); ++i) {
                errors[skies[i].name] = row.errors[i].relative_l2;
                flips[skies[i].name] = row.errors[i].flip_mean;
            }
            rows.push_back({{"method", row.method},
                            {"bytes_per_vertex", row.bytes_per_vertex},
                            {"relative_l2", errors},
                            {"flip_mean", flips},
                            {"frame_milliseconds", json_of(row.frame_milliseconds)},
                            {"relight_milliseconds", json_of(row.relight_milliseconds)}});
        }
        json.push_back({{"scene", scene.name},
                        {"vertices", scene.vertices},
                        {"triangles", scene.triangles},
                        {"channels", scene.channels},
                        {"device", scene.device},
                        {"methods", rows}});
    }
    return json;
}

void write(const std::filesystem::path& path, const std::string& text) {
    prt::OutputFile file(path);
    file.write(text);
    file.commit();
}

struct Arguments {
    std::vector<std::filesystem::path> scenes, skies;
    std::filesystem::path output, json, images;
    std::string note;
    comparison::Options options;
};

void add_options(CLI::App& app, Arguments& arguments) {
    comparison::Options& options = arguments.options;
    app.add_option("scenes", arguments.scenes, "glTF scenes")->required();
    app.add_option("--sky", arguments.skies, "environment maps; the pictures show the first one")->required();
    app.add_option("-o,--output", arguments.output, "output page, Markdown")->required();
    app.add_option("--images", arguments.images, "output folder for the pictures of the page")->required();
    app.add_option("--note", arguments.note, "last line of the page: sources of the scenes and skies");
    app.add_option("--json", arguments.json, "output file for all figures, JSON");
    app.add_option("--passes", options.passes, "number of paths per pixel of each reference")
        ->check(CLI::Range(1, 1 << 16))
        ->capture_default_str();
    app.add_option("--rays", options.bake_rays, "number of rays per vertex of the bake")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    app.add_option("--width", options.width, "width of the pictures in pixels")
        ->check(CLI::Range(16, 8192))
        ->capture_default_str();
    app.add_option("--height", options.height, "height of the pictures in pixels")
        ->check(CLI::Range(16, 8192))
        ->capture_default_str();
}

void run(const Arguments& arguments) {
    std::string why;
    const auto context = prt::GlContext::create(prt::GlDevice::any, &why);
    if (!context)
        throw prt::Error("OpenGL 4.5 is not available (" + why + ")");
    std::vector<comparison::Sky> skies;
    for (const auto& sky : arguments.skies)
        skies.push_back(comparison::load_sky(sky));
    std::vector<comparison::SceneResult> results;
    for (const auto& scene : arguments.scenes)
        results.push_back(
            comparison::measure(scene, skies, arguments.options, *context, [&](const std::string& what) {
                std::printf("%s: %s\n", scene.stem().c_str(), what.c_str());
                std::fflush(stdout);
            }));
    comparison::write_pictures(results, arguments.options, arguments.images);
    const std::filesystem::path folder = arguments.output.parent_path();
    const std::string images =
        std::filesystem::relative(arguments.images, folder.empty() ? "." : folder).generic_string();
    write(arguments.output, comparison::report(results, skies, arguments.options, images, arguments.note));
    if (!arguments.json.empty())
        write(arguments.json, json_of(results, skies).dump(2) + "\n");
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures unshadowed light, SSAO, baked AO and PRT against path tracing.", "prt-comparison");
    Arguments arguments;
    add_options(app, arguments);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        run(arguments);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "prt-comparison: error: %s\n", error.what());
        return 1;
    }
}

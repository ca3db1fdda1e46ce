// prt-viewer: shows models lit by precomputed radiance transfer.

#include "script/script.h"
#include "ui/window.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
    CLI::App app(
        "Shows models lit by precomputed radiance transfer, and by other methods of games for comparison.\n"
        "Key H shows the keys.",
        "prt-viewer");
    std::vector<std::filesystem::path> files;
    std::filesystem::path script;
    int width = 1280, height = 720;
    app.add_option("files", files,
                   "models (.glb, .gltf: unbaked, baked or compressed) and environments (.hdr, .exr)");
    app.add_option("--headless", script, "run the steps of this JSON file without a window (docs/viewer.md)");
    app.add_option("--width", width, "width of the window in pixels")
        ->check(CLI::Range(64, 16384))
        ->capture_default_str();
    app.add_option("--height", height, "height of the window in pixels")
        ->check(CLI::Range(64, 16384))
        ->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        if (script.empty())
            viewer::run_window(files, width, height);
        else
            viewer::run_script(script, files);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "prt-viewer: error: %s\n", error.what());
        return 1;
    }
}

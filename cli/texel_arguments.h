#pragma once

// Options of commands that bake into textures.

#include "inputs.h"
#include "prt/occlusion_maps.h"
#include "prt/texels.h"
#include "report/report.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace prt::cli {

struct TexelArguments {
    TexelOptions texels;
    std::optional<int> uv_set;
    std::optional<AtlasMode> atlas;
    bool unwrap = false;
    Path casters;
    std::optional<double> reach; ///< metres

    /// Whether textures are asked for.
    bool given() const { return texels.size > 0 || texels.per_metre > 0; }
};

/// The options that ask for textures.
struct TexelSizeOptions {
    CLI::Option *density, *size;
};

/// `what` begins what they say: "into textures".
TexelSizeOptions add_texels(CLI::App* command, TexelArguments& arguments, const std::string& what);

/// Throws `Error` for options of textures where none are asked for.
void check_texels(const TexelArguments& arguments);

/// A finer model, and how far off it may lie: a fiftieth of the scene's extent where that is not said.
struct Finer {
    std::optional<Scene> scene;
    double reach = 0;

    FinerModel model() const { return {scene ? &*scene : nullptr, reach}; }
};
Finer load_finer(const TexelArguments& arguments, const GltfOptions& reading, const Scene& scene);

/// Textures for the scene, and what was done for room in them.
struct TexelRoom {
    std::vector<Atlas> atlases;
    Json figures = Json::object();
};
/// Finds room for all surfaces of `scene`, read from `path`; with --unwrap document and scene get coordinates
/// of their own where there is none. Throws `Error`.
TexelRoom make_room(const TexelArguments& arguments, const Path& path, GltfDocument& document, Scene& scene);

} // namespace prt::cli

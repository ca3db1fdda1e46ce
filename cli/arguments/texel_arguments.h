#pragma once

// Options of commands that bake into textures.

#include "cli/pipeline/model.h"
#include "cli/program/session.h"
#include "cli/report/report.h"
#include "prt/bake/ambient_occlusion.h"
#include "prt/bake/texels.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace prt::cli {

struct TexelArguments {
    TexelOptions texels;
    const CLI::Option* option = nullptr; ///< --texels
    bool unwrap = false;                 ///< write new texture coordinates if the existing ones do not fit
    Path high_poly;                 ///< model whose surface blocks light and is lit, in place of the scene
    std::optional<double> distance; ///< maximum distance of that surface, metres

    /// True if textures are requested.
    bool given() const { return texels.size > 0 || texels.per_metre > 0; }
};

/// Adds --texels and --high-poly. Returns --texels. `text` says what is baked.
CLI::Option* add_texels(CLI::App* command, TexelArguments& arguments, const std::string& text);

/// Throws `Error` for settings of --texels and --high-poly without their values.
void check_texels(const TexelArguments& arguments);

/// The model of --high-poly, and its maximum distance: by default a fiftieth of the scene's extent.
struct HighPoly {
    std::optional<Scene> scene;
    double distance = 0;

    FinerModel model() const { return {scene ? &*scene : nullptr, distance}; }
};
/// Returns no scene without --high-poly.
HighPoly load_high_poly(const TexelArguments& arguments, const GltfOptions& reading, const Scene& scene);

/// Textures for the scene, and figures about their layout.
struct TexelRoom {
    std::vector<Atlas> atlases;
    Json figures = Json::object();
};
/// Finds space for all surfaces of `scene`, read from `path`. With `unwrap`, document and scene get new
/// coordinates if the existing ones have no space for every surface. Throws `Error`.
TexelRoom make_room(const TexelArguments& arguments, const Path& path, GltfDocument& document, Scene& scene);

} // namespace prt::cli

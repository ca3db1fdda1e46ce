// Parses texture options and prepares texture coordinates.

#include "texel_arguments.h"

#include "options.h"
#include "prt/support/error.h"
#include "prt/unwrap.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <map>
#include <utility>

namespace prt::cli {
namespace {

const std::map<std::string, AtlasMode> kAtlasModes = {
    {"auto", AtlasMode::automatic}, {"one", AtlasMode::one}, {"each", AtlasMode::each}};

/// "64/m" or "64".
double parse_density(const std::string& text) {
    const std::string number = text.ends_with("/m") ? text.substr(0, text.size() - 2) : text;
    const std::optional<double> density = real_number(number);
    if (!density || !(*density > 0) || !std::isfinite(*density))
        throw CLI::ValidationError("--texels", "'" + text + "' is no number of texels a metre, as 64/m");
    return *density;
}

/// Returns the options including those for coordinates and textures.
TexelOptions texel_options(const TexelArguments& a) {
    TexelOptions options = a.texels;
    options.uv_set = a.uv_set.value_or(options.uv_set);
    options.atlases = a.atlas.value_or(options.atlases);
    return options;
}

/// Generates new texture coordinates for the scene.
TexelRoom unwrapped(const TexelArguments& a, const Path& path, GltfDocument& document, Scene& scene) {
    Unwrapping unwrapping = unwrap(scene, texel_options(a));
    const int set = free_texcoord(scene);
    document = with_texcoords(std::move(document), scene, unwrapping.primitives, set);
    scene = extract_scene(document);
    for (Atlas& atlas : unwrapping.atlases)
        atlas.uv_set = set;
    print_notices(
        path.string(),
        {fmt::format("TEXCOORD_{} has {} now, {:.4g} texels a metre", set,
                     unwrapping.charts == 1 ? "one chart" : fmt::format("{} charts", unwrapping.charts),
                     unwrapping.texels_per_metre)});
    return {std::move(unwrapping.atlases),
            {{"charts", unwrapping.charts}, {"texels_per_metre", unwrapping.texels_per_metre}}};
}

} // namespace

TexelSizeOptions add_texels(CLI::App* command, TexelArguments& a, const std::string& what) {
    CLI::Option* density =
        command
            ->add_option_function<std::string>(
                "--texels", [&a](const std::string& text) { a.texels.per_metre = parse_density(text); },
                what + ", with so many texels a metre in the mean")
            ->type_name("N/m");
    CLI::Option* size =
        command->add_option("--size", a.texels.size, what + ", with so many texels along each side")
            ->check(CLI::Range(1, kMaxTexels))
            ->excludes(density);
    command->add_option("--uv", a.uv_set, "coordinates that textures use: TEXCOORD_n")
        ->default_str("1")
        ->check(CLI::Range(0, 7));
    command->add_flag(
        "--unwrap", a.unwrap,
        "where these coordinates have no place for every surface: cut the scene into charts, and write them "
        "as a set of their own");
    choice(command, "--atlas", a.atlas, kAtlasModes,
           "a texture for all, or for each object; auto: for all where their charts do not overlap", "auto");
    CLI::Option* casters =
        command
            ->add_option(
                "--casters", a.casters,
                "a finer model of the same, that blocks in the place of the scene: texels have what arrives "
                "at its surface")
            ->check(named)
            ->type_name("FILE");
    command
        ->add_option(
            "--reach", a.reach,
            "how far the finer surface may lie off, metres; otherwise a fiftieth of the scene's extent")
        ->check(above_zero())
        ->needs(casters);
    return {density, size};
}

void check_texels(const TexelArguments& a) {
    if (a.given())
        return;
    for (const auto& [given, option] : {std::pair(a.unwrap, "--unwrap"),
                                        {a.uv_set.has_value(), "--uv"},
                                        {a.atlas.has_value(), "--atlas"},
                                        {!a.casters.empty(), "--casters"}})
        if (given)
            throw Error(std::string(option) + " is for textures: give --size or --texels");
}

Finer load_finer(const TexelArguments& a, const GltfOptions& reading, const Scene& scene) {
    Finer finer;
    if (a.casters.empty())
        return finer;
    finer.scene = extract_scene(load_gltf(a.casters, reading));
    print_notices(a.casters.string(), finer.scene->notices);
    const Bounds box = bounds(scene);
    finer.reach = a.reach.value_or(static_cast<double>(glm::distance(box.low, box.high)) / 50);
    return finer;
}

TexelRoom make_room(const TexelArguments& a, const Path& path, GltfDocument& document, Scene& scene) {
    const TexelOptions options = texel_options(a);
    if (!a.unwrap)
        return {plan_atlases(scene, options)};
    try { // existing coordinates are kept if they have space for every surface
        TexelRoom room{plan_atlases(scene, options)};
        print_notices(path.string(), {fmt::format("has TEXCOORD_{} already, which is kept", options.uv_set)});
        return room;
    } catch (const Error&) { // that is why
        return unwrapped(a, path, document, scene);
    }
}

} // namespace prt::cli

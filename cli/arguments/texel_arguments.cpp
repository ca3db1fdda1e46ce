// Parses texture options and prepares texture coordinates.

#include "cli/arguments/texel_arguments.h"

#include "bake/products/lightmaps/unwrap.h"
#include "bake/reference/scene_lamps.h"
#include "cli/arguments/options.h"
#include "cli/arguments/suboptions.h"
#include "cli/program/session.h"
#include "prt/core/error.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace prt::cli {
namespace {

constexpr Choice<AtlasMode> kAtlasModes[] = {
    {"auto", AtlasMode::automatic, "one if the charts do not overlap, else each"},
    {"one", AtlasMode::one, "one texture for all objects"},
    {"each", AtlasMode::each, "a texture for each object"}};

/// Reads "1024", texels along each side, or "64/m", texels per metre.
void parse_size(const std::string& text, TexelOptions& texels) {
    const bool density = text.ends_with("/m");
    const std::optional<double> per_metre =
        density ? real_number(text.substr(0, text.size() - 2)) : std::nullopt;
    const std::optional<int> size = density ? std::nullopt : whole_number(text);
    if (density ? !per_metre || !(*per_metre > 0) || !std::isfinite(*per_metre)
                : !size || *size < 1 || *size > kMaxTexels)
        throw CLI::ValidationError(
            "--texels",
            fmt::format("'{}' is neither a number of texels in 1..{} nor texels per metre, as 64/m", text,
                        kMaxTexels));
    texels.per_metre = per_metre.value_or(0);
    texels.size = size.value_or(0);
}

/// Generates new texture coordinates for the scene.
TexelRoom unwrapped(const TexelArguments& a, const Path& path, GltfDocument& document, Scene& scene) {
    Unwrapping unwrapping = unwrap(scene, a.texels);
    const int set = free_texcoord(scene);
    document = with_texcoords(std::move(document), scene, unwrapping.primitives, set);
    scene = extract_scene(document);
    for (Atlas& atlas : unwrapping.atlases)
        atlas.uv_set = set;
    print_notices(
        path.string(),
        {fmt::format("TEXCOORD_{} has {} now, {:.4g} texels per metre", set,
                     unwrapping.charts == 1 ? "one chart" : fmt::format("{} charts", unwrapping.charts),
                     unwrapping.texels_per_metre)});
    return {std::move(unwrapping.atlases),
            {{"charts", unwrapping.charts}, {"texels_per_metre", unwrapping.texels_per_metre}}};
}

/// Adds the lights of `scene` to the detailed model, except those with the name of one of its lamps.
void add_lights(const Scene& scene, Scene& finer) {
    const std::vector<TransferTerm> own = lamps_of(finer);
    for (PunctualLight light : scene.lights)
        if (std::ranges::none_of(own, [&](const TransferTerm& lamp) { return lamp.name == light.name; })) {
            light.position += glm::vec3(scene.origin - finer.origin);
            finer.lights.push_back(std::move(light));
        }
}

} // namespace

CLI::Option* add_texels(CLI::App* command, TexelArguments& a, const std::string& text) {
    CLI::Option* texels =
        Suboptions("--texels", "N|N/m", text, [&a](const std::string& value) { parse_size(value, a.texels); })
            .detail("N: number of texels along each side of a texture, 1 to 8192")
            .detail(
                "N/m: mean number of texels per metre of surface, as 64/m; an error above 8192 along a side")
            .flag("unwrap", "create new texture coordinates if the set of uv=N is missing or unusable",
                  [&a] { a.unwrap = true; })
            .detail("  new set: the TEXCOORD after the last existing one; its number is printed")
            .detail("  unusable: overlaps within an object (node), with atlas=one also between objects,")
            .detail(
                "    has no area, crosses the border of the texture, or needs more than 8192 texels for N/m\n"
                "  back sides that --back-sides auto adds overlap the front sides: they need a new set")
            .detail("  without unwrap, a missing or unusable set is an error")
            .detail("  with unwrap, N is an error if the new charts do not fit")
            .whole_number("uv", 0, 7, "set of texture coordinates to use, TEXCOORD_N, 0 to 7 [1]",
                          [&a](int set) { a.texels.uv_set = set; })
            .key("atlas", names_of(kAtlasModes),
                 "one: a texture for all objects; each: a texture per object [auto]",
                 [&a](const std::string& name) { a.texels.atlases = chosen("--texels", kAtlasModes, name); })
            .detail("  auto: one if the charts of all objects do not overlap or the set is new, else each")
            .add(command);
    Suboptions(
        "--high-poly", "FILE",
        "trace rays against this detailed model instead of the scene\n"
        "FILE: .gltf or .glb, in the coordinate frame of the scene\n"
        "a vertex or texel is measured on the outermost detailed surface along its normal, within the\n"
        "  distance outwards and inwards, that faces the same way; if it is missing, on the scene\n"
        "  an error if it is missing everywhere\n"
        "prt bake: bounces, emissive materials and light of probes (--volume) are also those of FILE\n"
        "  lights: those of FILE, and those of the scene whose names FILE does not contain\n"
        "--no-shadow has no effect on this model",
        [&a](const std::string& file) {
            if (file.empty())
                throw CLI::ValidationError("--high-poly", "the name of the file is empty");
            a.high_poly = file;
        })
        .number("distance", 1e-9, 1e9,
                "maximum distance from the scene, metres [diagonal of its bounding box / 50]",
                [&a](double metres) { a.distance = metres; })
        .add(command);
    a.option = texels;
    return texels;
}

void check_texels(const TexelArguments& a) {
    if (a.high_poly.empty() && a.distance)
        throw Error("--high-poly needs a file, as --high-poly detailed.glb,distance=0.1");
    if (!a.given() && a.option->count() > 0)
        throw Error("--texels needs a size, as --texels 1024 or --texels 64/m");
}

HighPoly load_high_poly(const TexelArguments& a, const GltfOptions& reading, const Scene& scene) {
    HighPoly finer;
    if (a.high_poly.empty())
        return finer;
    finer.scene = extract_scene(load_gltf(a.high_poly, reading));
    print_notices(a.high_poly.string(), finer.scene->notices);
    add_lights(scene, *finer.scene);
    const Bounds box = bounds(scene);
    finer.distance = a.distance.value_or(static_cast<double>(glm::distance(box.low, box.high)) / 50);
    return finer;
}

TexelRoom make_room(const TexelArguments& a, const Path& path, GltfDocument& document, Scene& scene) {
    if (!a.unwrap)
        return {plan_atlases(scene, a.texels)};
    try { // existing coordinates are kept if they have space for every surface
        TexelRoom room{plan_atlases(scene, a.texels)};
        print_notices(path.string(),
                      {fmt::format("has TEXCOORD_{} already, which is kept", a.texels.uv_set)});
        return room;
    } catch (const Error&) { // that is why
        return unwrapped(a, path, document, scene);
    }
}

} // namespace prt::cli

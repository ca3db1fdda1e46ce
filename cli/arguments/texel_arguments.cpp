// Parses texture options and prepares texture coordinates.

#include "cli/arguments/texel_arguments.h"

#include "cli/arguments/options.h"
#include "cli/arguments/suboptions.h"
#include "cli/program/session.h"
#include "prt/core/error.h"

#include <fmt/core.h>

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

} // namespace

void add_high_poly(CLI::App* command, HighPolyRequest& a, const std::string& details) {
    Suboptions(
        "--high-poly", "FILE",
        "trace rays against this detailed model instead of the scene\n"
        "FILE: .gltf, .glb, .obj or .ply, in the coordinate frame of the scene\n"
        "a vertex or texel is measured on the outermost detailed surface along its normal, within the\n"
        "  distance outwards and inwards, that faces the same way; if it is missing, on the scene\n"
        "  an error if it is missing everywhere" +
            details,
        [&a](const std::string& file) {
            if (file.empty())
                throw CLI::ValidationError("--high-poly", "the name of the file is empty");
            a.file = file;
        })
        .number("distance", 1e-9, 1e9,
                "maximum distance from the scene, metres [diagonal of its bounding box / 50]",
                [&a](double metres) { a.distance = metres; })
        .add(command);
}

void check_high_poly(const HighPolyRequest& a) {
    if (a.file.empty() && a.distance)
        throw Error("--high-poly needs a file, as --high-poly detailed.glb,distance=0.1");
}

CLI::Option* add_texels(CLI::App* command, TexelRequest& a, const std::string& text) {
    CLI::Option* texels =
        Suboptions("--texels", "N|N/m", text, [&a](const std::string& value) { parse_size(value, a.texels); })
            .detail("N: number of texels along each side of a texture, 1 to 8192")
            .detail("N/m: mean texels per metre of surface, above 0, as 64/m or 0.5/m; an error above 8192 a "
                    "side")
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
    add_high_poly(
        command, a.high_poly,
        "\nprt bake: bounces, emissive materials and light of probes (--volume) are also those of FILE\n"
        "  lights: those of FILE, and those of the scene whose names FILE does not contain\n"
        "--no-shadow has no effect on this model");
    return texels;
}

void check_texels(const TexelRequest& a, const CLI::Option* texels) {
    check_high_poly(a.high_poly);
    if (!a.given() && texels->count() > 0)
        throw Error("--texels needs a size, as --texels 1024 or --texels 64/m");
}

} // namespace prt::cli

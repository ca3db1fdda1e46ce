// prt bake: bakes transfer into vertices, textures, volumes or instances.

#include "cli/commands/commands.h"

#include "cli/arguments/light_arguments.h"
#include "cli/arguments/options.h"
#include "cli/arguments/scene_arguments.h"
#include "cli/arguments/suboptions.h"
#include "cli/arguments/texel_arguments.h"
#include "cli/arguments/trace_arguments.h"
#include "cli/arguments/volume_arguments.h"
#include "cli/pipeline/bake_model.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"
#include "prt/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace prt::cli {
namespace {

constexpr Choice<LobesOfFile> kLobesOfFile[] = {
    {"keep", LobesOfFile::keep, "their vertices get no transfer, but block and reflect light in this pose"},
    {"remove", LobesOfFile::remove, "their vertices get transfer, which does not move with the figure"}};

struct BakeArguments : BakeRequest {
    Path json;
    const CLI::Option *texels_option = nullptr, *volume_option = nullptr;
};

constexpr Choice<std::optional<TransferStorage>> kStorages[] = {
    {"auto", std::nullopt,
     "float16 if its rounding error is below 1/10 of the noise of the rays, else float32\n"
     "  probes of --volume: float16 if its rounding error is below 0.1 %, else float32"},
    {"float16", TransferStorage::float16, "2 bytes per coefficient; not for coefficients above 65504"},
    {"float32", TransferStorage::float32, "4 bytes per coefficient"}};
constexpr Choice<bool> kDenoise[] = {
    {"on", true, "smooth light over the surface, as far as its differences are noise"},
    {"off", false, "write the traced values with their noise"}};
constexpr Choice<LampMode> kLampModes[] = {
    {"all", LampMode::all, "direct light and bounces"},
    {"indirect", LampMode::indirect,
     "bounces only, for renderers that add the direct light of lamps with shadows\n"
     "  black with --bounces 0, except light through a medium"},
    {"none", LampMode::none, "no light of lamps, only light of the sky; radius, rays and group are errors"}};

int parse_bounces(const std::string& text) {
    if (text == "inf")
        return kEndlessBounces;
    const std::optional<int> bounces = whole_number(text);
    if (!bounces || *bounces < 0 || *bounces > kMaxBounces)
        throw CLI::ValidationError(
            "--bounces",
            fmt::format("'{}' is neither a number of bounces in 0..{} nor inf", text, kMaxBounces));
    return *bounces;
}

constexpr double kPerMillimetre = 1000; ///< in 1/m

/// True if all three components are in the range; false for NaN.
bool all_in(const glm::dvec3& v, double low, double high) {
    return v.x >= low && v.x <= high && v.y >= low && v.y <= high && v.z >= low && v.z <= high;
}

/// Returns "marble, skin1, ...", in lines of help.
std::string names_of_media() {
    std::string names;
    std::size_t line = 0;
    for (const NamedMedium& named : measured_media()) {
        if (names.size() - line > 70) {
            names += ",\n      ";
            line = names.size();
        }
        names += (names.size() == line ? (line > 0 ? " " : "") : ", ") + std::string(named.name);
    }
    return names;
}

/// [MATERIAL=]MEDIUM, where MEDIUM is a name or six coefficients in 1/mm.
MediumChoice parse_medium(const std::string& text) {
    MediumChoice choice;
    const std::size_t equals = text.rfind('=');
    if (equals != std::string::npos)
        choice.material = text.substr(0, equals);
    const std::string medium = equals == std::string::npos ? text : text.substr(equals + 1);
    std::string names;
    for (const NamedMedium& named : measured_media()) {
        if (named.name == medium) {
            choice.medium = named.medium;
            return choice;
        }
        names += std::string(named.name) + ", ";
    }
    glm::dvec3 &s = choice.medium.scattering, &a = choice.medium.absorption;
    int used = 0;
    if (std::sscanf(medium.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf%n", &s.x, &s.y, &s.z, &a.x, &a.y, &a.z, &used) !=
            6 ||
        static_cast<std::size_t>(used) != medium.size() ||
        !all_in(s * kPerMillimetre, kMinScattering, kMaxCoefficient) ||
        !all_in(a * kPerMillimetre, 0, kMaxCoefficient))
        throw CLI::ValidationError("--subsurface",
                                   "'" + medium + "' is neither one of " + names +
                                       "nor six coefficients sr,sg,sb,ar,ag,ab in 1/mm (scattering "
                                       "at least 1e-12, all at most 1e6)");
    s *= kPerMillimetre;
    a *= kPerMillimetre;
    return choice;
}

void add_subsurface(CLI::App* command, SubsurfaceOptions& subsurface) {
    command
        ->add_option_function<std::vector<std::string>>(
            "--subsurface",
            [&subsurface](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) {
                    MediumChoice choice = parse_medium(text);
                    if (std::ranges::any_of(subsurface.media, [&](const MediumChoice& other) {
                            return other.material == choice.material;
                        }))
                        throw CLI::ValidationError("--subsurface",
                                                   choice.material.empty()
                                                       ? "all materials have two media"
                                                       : "'" + choice.material + "' has two media");
                    subsurface.media.push_back(std::move(choice));
                }
            },
            "add subsurface scattering; without MATERIAL=: to all materials\n"
            "MEDIUM: a name from the list below, or six numbers sr,sg,sb,ar,ag,ab in 1/mm\n"
            "sr,sg,sb: reduced scattering of red, green and blue light; ar,ag,ab: absorption\n"
            "  1/mm: for a scene in metres, else see --metres-per-unit; sr: 1e-12 to 1e6, ar: 0 to 1e6\n"
            "names: " +
                names_of_media() +
                "\n"
                "repeat the option for several materials, each once; type an entry for all materials\n"
                "  first: it replaces the entries before it\n"
                "an unknown material is an error\n"
                "default: materials scatter that have KHR_materials_diffuse_transmission, and\n"
                "  KHR_materials_volume with thickness and attenuation distance\n"
                "  an entry of --subsurface replaces their medium")
        ->allow_extra_args(false) // one each time, so that the scene may follow
        ->type_name("[MATERIAL=]MEDIUM");
    command
        ->add_option("--metres-per-unit", subsurface.metres_per_unit,
                     "length of one unit of the scene in metres; needs --subsurface\n"
                     "1e-9 to 1e9; also applied to KHR_materials_volume, not to lamps and distances")
        ->capture_default_str()
        ->check(real_in(1e-9, 1e9));
}

void add_transport(CLI::App* command, BakeOptions& options) {
    command
        ->add_option_function<std::string>(
            "--bounces", [&options](const std::string& text) { options.bounces = parse_bounces(text); },
            "number of bounces between surfaces; 0: direct light only\n"
            "N: 0 to 10000; inf: all bounces, until the remaining light is negligible\n"
            "  inf is an error for lamps in a closed room that reflects all light (base color 1)")
        ->type_name("N|inf")
        ->default_str("0");
    add_subsurface(command, options.subsurface);
    add_enclosed(command, options.repairs.inside);
}

/// NAME=PATTERN
LampGroup parse_group(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
        throw CLI::ValidationError("--lamps", "group=" + text + ": expected NAME=PATTERN");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

void add_lamps(CLI::App* command, LampOptions& lamps) {
    Suboptions("--lamps", names_of(kLampModes), "part of the light of lamps that is baked",
               [&lamps](const std::string& name) { lamps.mode = chosen("--lamps", kLampModes, name); })
        .detail("lamps: lights of the scene (KHR_lights_punctual) and emissive materials\n"
                "  lamps of the same name and the lamps of a group are one lamp; at most 64 lamps\n"
                "--instances shared: lamps are traced at the vertices of all instances")
        .detail(explained(kLampModes).substr(1))
        .number("radius", 0, 1e9, "radius of point and spot lights, metres; larger: softer shadows [0]",
                [&lamps](double metres) { lamps.radius = metres; })
        .whole_number("rays", 1, kMaxRays,
                      "rays from a vertex, texel or probe to each lamp, 1 to 2^24 [64]\n"
                      "  N to its emissive materials, N to its lights with radius, one to each other light",
                      [&lamps](int rays) { lamps.rays = rays; })
        .key("group", "NAME=PATTERN", "combine lamps whose names match PATTERN into one lamp NAME",
             [&lamps](const std::string& text) { lamps.groups.push_back(parse_group(text)); })
        .repeatable()
        .detail("  repeat group= for several groups; a lamp belongs to the first group that matches\n"
                "  name: of the node of a light (if it has none, of the light), or of an emissive material")
        .detail("  PATTERN: whole name; *: any number of characters, ?: one; upper and lower case differ\n"
                "  errors: a group without lamps, and NAME that is the name of a lamp outside the group")
        .add(command)
        ->default_str("all");
}

void add_measurement(CLI::App* command, BakeOptions& options) {
    choice(command, "--denoise", options.repairs.denoise, kDenoise,
           "removal of the noise of rays from the baked light\n"
           "no effect with --refine, --fit surface (also if --fit auto chooses it), --method raster\n"
           "if --instances shares transfer: effect only on bounces of lamps, and on coarser levels of\n"
           "  --levels own\n"
           "no effect on direct light of lamps, on probes of --volume, on materials with subsurface\n"
           "  scattering, and without --texels also on diffuse transmission",
           "on");
    add_device(command, options.tracer);
    add_fit(command, options.fit,
            "measure light at the vertices, or at points between them\n"
            "not with --texels\n"
            "with --refine: auto acts as surface; vertex is an error\n"
            "else with --target-error, --method raster or shared instances: auto acts as vertex\n"
            "  light of lamps in a bake with shared transfer: as without shared transfer\n"
            "  surface fits shared transfer to the surface, but not the 52 bytes of an instance");
    add_method(command, options.tracer,
               "bounces, lamps, probes, errors for --refine, and the effect of its surroundings on an\n"
               "    instance that shares transfer");
}

void add_refinement(CLI::App* command, BakeArguments& a) {
    Suboptions("--refine", "ERROR", "split triangles until light between vertices has at most this error",
               [&a](const std::string& text) {
                   if (const std::string wrong = above_zero()(text); !wrong.empty())
                       throw CLI::ValidationError("--refine", wrong);
                   a.finer.refine = real_number(text);
               })
        .detail("ERROR: above 0; relative L2 error of interpolation of direct light; 0.02: 2 %\n"
                "  over the whole surface, not of each triangle; light of the sky, not of lamps")
        .detail("the written mesh contains the new vertices; coarser levels of detail are not split")
        .detail("stops earlier at the maximum number of vertices, and at very short edges; default: no split")
        .detail("fits light to the surface (--fit surface); not with --fit vertex and --texels\n"
                "--instances shared: meshes that share transfer are not split; --instances auto acts as own")
        .whole_number("vertices", 1, std::numeric_limits<int>::max(),
                      "maximum number of vertices, 1 or more [4 x those of the scene, at least 20000]",
                      [&a](int count) { a.finer.max_vertices = static_cast<std::size_t>(count); })
        .add(command);
}

void check_arguments(const BakeArguments& a) {
    check_texels(a.texels, a.texels_option);
    check_volume(a.volume, a.volume_option);
    if (a.finer.max_vertices > 0 && !a.finer.refine)
        throw CLI::ValidationError("--refine", "needs an error, as --refine 0.02,vertices=50000");
    const LampOptions usual;
    if (a.options.lamps.mode == LampMode::none &&
        (!a.options.lamps.groups.empty() || a.options.lamps.radius != usual.radius ||
         a.options.lamps.rays != usual.rays))
        throw CLI::ValidationError("--lamps", "none has no settings");
    check_method(a.options.tracer);
    if (a.options.subsurface.media.empty() && a.options.subsurface.metres_per_unit != 1)
        throw CLI::ValidationError("--metres-per-unit", "needs --subsurface");
}

void run(BakeArguments a, Session& session) {
    check_device(a.options.tracer);
    check_arguments(a);
    std::vector<Path> inputs = a.instances.lights;
    inputs.insert(inputs.end(), {a.scene, a.texels.high_poly.file});
    a.reading.outputs =
        check_outputs({{a.output, "--output", {".glb"}}, {a.json, "--json", {".json"}}}, inputs);
    Report report = bake_model(a, load_gltf(a.scene, a.reading), session.host());
    publish(report, a.json, session);
}

} // namespace

void add_bake(CLI::App& app, Session& session) {
    CLI::App* command =
        app.add_subcommand("bake", "Bake transfer of a glTF scene at vertices, texels and probes");
    auto& a = arguments_for<BakeArguments>(command,
                                           [&session](const BakeArguments& given) { run(given, session); });
    command->add_option("scene", a.scene, "scene to bake: glTF 2.0 (.gltf, .glb), or a mesh, .obj or .ply")
        ->required()
        ->check(named);
    add_output(command, a.output, "write the scene with its transfer to this file, .glb");
    command
        ->add_option("--order", a.options.order,
                     "SH order N of the transfer, 1 to 10: N² coefficients\n"
                     "N bands, l = 0 to N - 1; a larger N has sharper shadows and needs more time and bytes")
        ->capture_default_str()
        ->check(CLI::Range(1, kMaxOrder));
    CLI::Option* rays =
        command
            ->add_option(
                "--rays", a.options.rays,
                "number of rays per vertex, texel or probe, 1 to 2^24\n"
                "not with --target-error (probes: --volume METRES,rays=N); to lamps: --lamps all,rays=N\n"
                "with --method raster: number of directions of depth maps, the same for all vertices")
            ->capture_default_str()
            ->check(CLI::Range(1, kMaxRays));
    add_target_error(command, rays, a.options.target_error,
                     "\nthe noise before --denoise; the number of rays differs between vertices\n"
                     "  it is the same for all with --texels, --fit surface, --refine and --method raster\n"
                     "with shared instances: of each mesh alone, and of all surfaces that are drawn once\n"
                     "no effect on probes of --volume and on the errors for --refine");
    add_transport(command, a.options);
    add_lamps(command, a.options.lamps);
    add_lamp_scale(command, a.reading.lamp_scale,
                   "\nthe written file contains the scaled lights; do not scale them again");
    add_no_shadow(command, a.no_shadow, "\nno effect on the model of --high-poly");
    add_measurement(command, a.options);
    add_refinement(command, a);
    add_back_sides(
        command, a.back_sides,
        "\nalways shared for --texels without unwrap\n"
        "instances that share transfer have the same vertices: light at one of them is sufficient");
    a.texels_option = add_texels(command, a.texels,
                                 "bake lightmaps instead of vertices: N x N texels, or N per metre\n"
                                 "not with --fit, --refine and --instances shared")
                          ->excludes(command->get_option("--fit")); // texels measure light at their centers
    a.volume_option = add_volume(command, a.volume);
    add_instances(command, a.instances);
    add_levels(command, a.kept.levels,
               "\n--texels: coarser levels get no lightmap\n"
               "--instances shared and auto: with carry and own, instances that have levels: as own");
    choice(command, "--stored-lobes", a.kept.lobes, kLobesOfFile,
           "lobes of prt lobes that the scene contains", "keep");
    choice(command, "--storage", a.options.memory.storage, kStorages,
           "number format of the coefficients in the file", "auto");
    add_seed(command, a.options.seed);
    add_reading(command, a.reading, &a.options.memory.limit);
    add_smooth_normals(command, a.reading);
    add_threads(command, a.options.threads);
    add_json(command, a.json);
}

} // namespace prt::cli

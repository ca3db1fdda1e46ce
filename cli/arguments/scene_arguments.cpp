// Adds options for the geometry of a scene.

#include "cli/arguments/scene_arguments.h"

#include "cli/arguments/light_arguments.h"
#include "cli/arguments/options.h"
#include "cli/arguments/suboptions.h"
#include "cli/program/session.h"

namespace prt::cli {
namespace {

constexpr Choice<BackSides> kBackSides[] = {
    {"auto", BackSides::automatic,
     "add vertices for back sides that light reaches; each side then has its own light\n"
     "  light: of the sky above the horizon and of lamps (not prt lobes), also after reflections"},
    {"shared", BackSides::shared, "back sides show the light of the front sides"}};
constexpr Choice<LevelMode> kLevelModes[] = {
    {"carry", LevelMode::carry, "fit the light of level 0 to the surface of the coarser level"},
    {"own", LevelMode::own,
     "also bake the coarser levels, shown instead of level 0; each takes as long as level 0\n"
     "  an error if a level has other lamps, or needs other terms or colors, than level 0"},
    {"ignore", LevelMode::ignore, "coarser levels get no transfer"}};
constexpr Choice<InstanceMode> kInstanceModes[] = {
    {"own", InstanceMode::own, "bake each instance with its own transfer"},
    {"shared", InstanceMode::shared,
     "bake a mesh once; 52 bytes per instance describe the effect of its surroundings\n"
     "  instances that are mirrored, sheared, skinned or morphed, or have unequal scale: as own\n"
     "  an error if no mesh has at least two instances that can share\n"
     "  not with --texels and --high-poly; with --refine, these meshes are not split\n"
     "  with subsurface scattering, instances of another scale than most of their mesh: as own\n"
     "  instances that have coarser levels of detail: as own, except with --levels ignore\n"
     "  lamps: traced at the vertices of all instances; 304 bytes more per lamp and instance"},
    {"auto", InstanceMode::automatic,
     "shared if possible and if it saves at least 3/4 of the rays of these meshes, else own\n"
     "  rays to lamps do not count"}};

} // namespace

void add_no_shadow(CLI::App* command, std::vector<std::string>& materials, const std::string& details) {
    command
        ->add_option(
            "--no-shadow", materials,
            "name of a material that casts no shadow; repeat the option for several\n"
            "for example of a sky dome; an unknown name is an error; default: all cast shadows\n"
            "rays pass through its surfaces, which reflect no light to others; emissive ones stay lamps" +
                details)
        ->allow_extra_args(false)
        ->type_name("MATERIAL");
}

void add_back_sides(CLI::App* command, BackSides& sides, const std::string& details) {
    choice(command, "--back-sides", sides, kBackSides,
           "light of the back sides of double-sided materials" + details +
               "\nalways shared for surfaces with alpha blending or subsurface scattering, and with a\n"
               "  single-sided material variant (KHR_materials_variants)",
           "auto");
}

void add_levels(CLI::App* command, LevelMode& mode, const std::string& details) {
    choice(command, "--levels", mode, kLevelModes,
           "transfer of coarser levels: from level 0, own bakes, or none\n"
           "levels of detail: nodes of MSFT_lod, or sibling nodes with names as ROCK_LOD0, ROCK_LOD1" +
               details,
           "carry");
}

void add_instances(CLI::App* command, InstanceArguments& arguments) {
    arguments.notify = print_notices;
    Suboptions("--instances", names_of(kInstanceModes), "transfer of meshes that are drawn several times",
               [&arguments](const std::string& name) {
                   arguments.mode = chosen("--instances", kInstanceModes, name);
               })
        .detail(explained(kInstanceModes).substr(1))
        .number("error", 0, 1e9,
                "bake an instance as own if its relative L2 error is above X, 0 to 1e9 [0.1]\n"
                "  0.1: 10 %; the largest of the errors under five built-in soft skies together,\n"
                "  under each FILE of --lights, and under all lamps together",
                [&arguments](double error) {
                    arguments.error = error;
                    arguments.settings = true;
                })
        .whole_number("samples", 8, 1 << 20,
                      "limit of vertices of an instance that are traced in its surroundings [256]\n"
                      "  8 to 1048576; each with 1/16 of --rays, at least 16",
                      [&arguments](int samples) {
                          arguments.bake.samples = samples;
                          arguments.settings = true;
                      })
        .detail("error and samples need shared or auto")
        .add(command)
        ->default_str("own");
    CLI::Option* const lights = add_lights(
        command, arguments.lights,
        "light under which errors of shared instances are measured\n"
        "needs --instances shared or auto; five built-in soft skies are always tested too\n"
        "light file: at least of the order of --order\n"
        "an instance is baked as own if its error under a FILE, under the five skies together, or\n"
        "  under all lamps together is above error=X of --instances; default: no FILE");
    add_suns(
        command, arguments.suns,
        std::string("number of suns of --lights for which a renderer has shadow maps\n"
                    "needs --lights; the direct light of these suns is not part of the measured light\n") +
            kSunsOfLightFiles,
        "0");
    command->get_option("--suns")->needs(lights);
}

} // namespace prt::cli

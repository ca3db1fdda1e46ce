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
     "add vertices, so that each side has its own light, if light reaches both sides"},
    {"shared", BackSides::shared, "back sides show the light of the front sides"}};
constexpr Choice<LevelMode> kLevelModes[] = {
    {"carry", LevelMode::carry, "fit the light of level 0 to the surface of the coarser level"},
    {"own", LevelMode::own, "bake each coarser level instead of level 0; each takes as long as level 0"},
    {"ignore", LevelMode::ignore, "coarser levels get no transfer"}};
constexpr Choice<InstanceMode> kInstanceModes[] = {
    {"own", InstanceMode::own, "bake each instance with its own transfer"},
    {"shared", InstanceMode::shared,
     "bake a mesh once; 52 bytes per instance describe the effect of its surroundings"},
    {"auto", InstanceMode::automatic,
     "shared if possible and if it saves at least 3/4 of the rays, else own"}};

} // namespace

void add_no_shadow(CLI::App* command, std::vector<std::string>& materials) {
    command
        ->add_option("--no-shadow", materials,
                     "name of a material that casts no shadow; repeat for several\n"
                     "for example a sky dome; default: all materials cast shadows\n"
                     "prt evaluate: the names that prt bake got; used by --measure budget and volume")
        ->allow_extra_args(false)
        ->type_name("MATERIAL");
}

void add_back_sides(CLI::App* command, BackSides& sides) {
    choice(command, "--back-sides", sides, kBackSides, "light of the back sides of double-sided materials",
           "auto");
}

void add_levels(CLI::App* command, LevelMode& mode) {
    choice(command, "--levels", mode, kLevelModes,
           "transfer of coarser levels of detail\n"
           "levels: nodes of MSFT_lod, or nodes with names as ROCK_LOD1",
           "carry");
}

void add_instances(CLI::App* command, InstanceArguments& arguments) {
    arguments.notify = print_notices;
    Suboptions("--instances", names_of(kInstanceModes), "transfer of meshes that are drawn several times",
               [&arguments](const std::string& name) {
                   arguments.mode = chosen("--instances", kInstanceModes, name);
               })
        .detail(explained(kInstanceModes).substr(1))
        .number("error", 0, 1e9, "bake an instance as own if its relative L2 error is larger than X [0.1]",
                [&arguments](double error) {
                    arguments.error = error;
                    arguments.settings = true;
                })
        .whole_number("samples", 8, 1 << 20,
                      "maximum number of vertices traced per instance, in its surroundings [256]",
                      [&arguments](int samples) {
                          arguments.bake.samples = samples;
                          arguments.settings = true;
                      })
        .add(command)
        ->default_str("own");
    CLI::Option* const lights =
        add_lights(command, arguments.lights,
                   "light under which shared instances must have at most error=X\n"
                   "error=X: the setting of --instances shared or auto; five soft skies are always tested");
    add_suns(command, arguments.suns, "number of suns of --lights for which a renderer has shadow maps", "0");
    command->get_option("--suns")->needs(lights);
}

} // namespace prt::cli

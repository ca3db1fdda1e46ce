// Suggests the nearest known command or option.

#include "cli/arguments/known_names.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace prt::cli {
namespace {

/// Returns the minimum number of letters to change, add or remove to convert one word to the other
/// (Levenshtein 1965).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

std::vector<std::string> names_of_options(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
    return names;
}

bool is_in(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns "; did you mean bake?", or "; available: " and all names if no name is near.
std::string suggestion(const std::vector<std::string>& names, const std::string& name) {
    std::string all, nearest;
    std::size_t least = 3;
    for (const std::string& known : names) {
        all += (all.empty() ? "" : ", ") + known;
        if (const std::size_t distance = edit_distance(name, known); distance < least) {
            least = distance;
            nearest = known;
        }
    }
    return nearest.empty() ? "; available: " + all : "; did you mean " + nearest + "?";
}

/// An option that has another name now.
struct OldName {
    std::string_view command; ///< empty: all commands
    std::string_view old, now;
};
constexpr OldName kOldNames[] = {
    {"", "--env", "--lights FILE"},
    {"", "--backend", "--device auto|cpu|gpu"},
    {"render", "--gpu", "--device auto|cpu|gpu"},
    {"", "--gpu", "--device N|NAME"},
    {"", "--traversal", "--device gpu,traversal=auto|compute|device"},
    {"bench", "--list-devices", "--device list"},
    {"", "--html", "--report FILE.html"},
    {"", "--csv", "--report FILE.csv"},
    {"", "--scene-limit", "--memory-limit SIZE"},
    {"", "--env-center", "--env-layout lat-long|lat-long-x"},
    {"bake", "--size", "--texels N"},
    {"ao", "--size", "--texels N"},
    {"", "--uv", "--texels N,uv=N"},
    {"", "--unwrap", "--texels N,unwrap"},
    {"", "--atlas", "--texels N,atlas=auto|one|each"},
    {"", "--casters", "--high-poly FILE"},
    {"", "--reach", "--high-poly FILE,distance=METRES"},
    {"", "--volume-probes", "--volume probes=N"},
    {"", "--volume-error", "--volume METRES,error=X"},
    {"", "--volume-order", "--volume METRES,order=N"},
    {"", "--volume-bounds", "--volume METRES,bounds=x0,y0,z0,x1,y1,z1"},
    {"compress", "--volume-bytes", "--volume bytes=N"},
    {"compress", "--volume-clusters", "removed: the number of clusters follows from the probes"},
    {"", "--volume-fit", "--volume METRES,fit=X"},
    {"ao", "--volume", "--occluders"},
    {"evaluate", "--volume", "--measure volume"},
    {"shader", "--volume", "--stage volume"},
    {"", "--instance-error", "--instances shared,error=X"},
    {"", "--instance-samples", "--instances shared,samples=N"},
    {"bake", "--instance-lights", "--lights FILE"},
    {"", "--lamp-radius", "--lamps all,radius=METRES"},
    {"", "--lamp-group", "--lamps all,group=NAME=PATTERN"},
    {"relight", "--sun-rays", "--suns auto,rays=N"},
    {"render", "--sun-rays", "--suns auto,rays=N"},
    {"", "--lamp-rays", "--lamps all,rays=N"},
    {"relight", "--lamps", "--lamp-strengths on|off|FILE"},
    {"render", "--lamps", "--lamp-strengths on|off|FILE"},
    {"", "--raster-resolution", "--method raster,resolution=N"},
    {"", "--most-vertices", "--refine ERROR,vertices=N"},
    {"", "--inside", "--enclosed keep|refill"},
    {"", "--guides", "--predictors none|normal|position"},
    {"", "--whole", "--combine-direct"},
    {"compress", "--weights", "--bits float"},
    {"compress", "--metric", "--lights outdoor|indoor|day|natural|plain"},
    {"", "--bytes-per-texel", "--bytes-per-vertex X"},
    {"make", "--baked", "--keep-bake FILE"},
    {"", "--sweep", "--measure sweep"},
    {"", "--budget", "--measure budget"},
    {"", "--albedo", "--colors albedo"},
    {"", "--unlit", "--colors unlit"},
    {"shader", "--compute", "--stage compute"},
    {"shader", "--fragment", "--stage fragment"},
    {"shader", "--instances", "--stage instances"},
    {"shader", "--occluders", "--stage occluders"},
    {"shader", "--lobes", "--stage lobes"},
    {"", "--distance", "--max-distance METRES"},
    {"", "--frames", "--poses N,frames=N"},
    {"", "--animation", "--poses N,animation=NAME"},
    {"bench", "--from", "--rays FROM..TO"},
    {"bench", "--to", "--rays FROM..TO"},
    {"bench", "--most-seconds", "--seconds X"},
};

/// Throws the new name of an option if `name` is an old one and the command has the new one. `names`: options
/// of the command.
void check_old_name(const std::string& command, const std::vector<std::string>& names,
                    const std::string& name) {
    for (const OldName& old : kOldNames)
        if (name == old.old && (old.command.empty() || command == old.command) &&
            (old.now.starts_with("removed") ||
             is_in(names, std::string(old.now.substr(0, old.now.find(' '))))))
            throw CLI::ParseError(name + (old.now.starts_with("removed") ? " is " : " is now ") +
                                      std::string(old.now),
                                  CLI::ExitCodes::ExtrasError);
}

[[noreturn]] void refuse(const char* what, const std::string& name, const std::vector<std::string>& names) {
    throw CLI::ParseError("unknown " + std::string(what) + " '" + name + "'" + suggestion(names, name),
                          CLI::ExitCodes::ExtrasError);
}

} // namespace

void check_names(const CLI::App& app, std::span<char* const> words) {
    const CLI::App* command = &app;
    for (const std::string word : words) {
        if (word == "--")
            return;
        const bool option = word.starts_with("-");
        if (option && word.starts_with("--")) {
            const std::string name = word.substr(0, word.find('='));
            if (const auto names = names_of_options(*command); !is_in(names, name)) {
                check_old_name(command->get_name(), names, name);
                refuse("option", name, names);
            }
        } else if (!option && command == &app) {
            const auto names = names_of_commands(app);
            if (!is_in(names, word))
                refuse("command", word, names);
            command = app.get_subcommand(word);
        }
    }
}

} // namespace prt::cli

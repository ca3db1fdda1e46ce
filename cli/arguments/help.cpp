// Formats the help of commands.

#include "cli/arguments/help.h"

#include <algorithm>
#include <utility>

namespace prt::cli {
namespace {

constexpr std::size_t kColumn = 30; ///< start of the descriptions

/// Removes the descriptions of validators, which CLI11 appends to the name of the value.
std::string value_name(const CLI::Option& option) {
    static const std::pair<std::string_view, std::string_view> kTypes[] = {
        {"INT", "N"}, {"UINT", "N"}, {"FLOAT", "X"}, {"TEXT", "NAME"}};
    std::string name = option.get_type_name();
    for (const char* validator : {":{", ":INT", ":UINT", ":FLOAT", ":POSITIVE", ":FILE", ":SIZE"})
        name = name.substr(0, name.find(validator));
    for (const auto& [type, shown] : kTypes)
        if (name == type)
            return std::string(shown);
    return name;
}

std::string left_column(const CLI::Option& option) {
    std::string names;
    for (const std::string& name : option.get_snames())
        names += "-" + name + ", ";
    for (const std::string& name : option.get_lnames())
        names += "--" + name;
    const std::string value = option.get_items_expected() > 0 ? value_name(option) : "";
    return "  " + names + (value.empty() ? "" : " " + value);
}

/// Returns the line of an option and, for `all`, the lines of its details.
std::string lines_of(const CLI::Option& option, bool all) {
    std::string line = left_column(option);
    line += std::string(line.size() + 2 > kColumn ? 2 : kColumn - line.size(), ' ');
    const std::string& text = option.get_description();
    const std::size_t end = std::min(text.find('\n'), text.size());
    line += text.substr(0, end);
    const std::string usual = option.get_default_str();
    if (option.get_required())
        line += " (required)";
    else if (!usual.empty())
        line += " [" + usual + "]";
    line += "\n";
    for (std::size_t at = end; all && at < text.size();) {
        const std::size_t next = std::min(text.find('\n', at + 1), text.size());
        line += "        " + text.substr(at + 1, next - at - 1) + "\n";
        at = next;
    }
    return line;
}

/// Returns the lines of positional arguments.
std::string arguments_of(const CLI::App& command) {
    std::string lines;
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional()) {
            const std::string name = "  " + option->get_name(true);
            lines += name + std::string(kColumn - std::min(name.size(), kColumn - 1), ' ') +
                     option->get_description() + (option->get_required() ? "" : " (optional)") + "\n";
        }
    return lines.empty() ? "" : "\nArguments:\n" + lines;
}

const CLI::Option* find(const CLI::App& app, std::string_view name) {
    for (const CLI::Option* option : app.get_options())
        if (!option->get_positional() && option->check_lname(std::string(name)))
            return option;
    return nullptr;
}

std::string groups_of(const CLI::App& app, bool all) {
    std::string text;
    for (const HelpGroup& group : help_groups()) {
        std::vector<std::string_view> names = group.common;
        if (all)
            names.insert(names.end(), group.rare.begin(), group.rare.end());
        std::string lines;
        for (const std::string_view name : names)
            if (const CLI::Option* option = find(app, name))
                lines += lines_of(*option, all);
        if (!lines.empty())
            text += "\n" + std::string(group.title) + ":\n" + lines;
    }
    return text;
}

} // namespace

const std::vector<HelpGroup>& help_groups() {
    static const std::vector<HelpGroup> kGroups = {
        {"Output",
         {"output", "json", "report", "keep-bake", "stage", "language", "constants", "colors"},
         {"trace"}},
        {"Lights",
         {"lights", "suns", "rotate", "exposure", "lamp-strengths"},
         {"window", "env-layout", "layer", "bad-pixels", "rotations"}},
        {"Picture",
         {"size", "camera", "look-at", "fov", "show", "baked", "path-trace"},
         {"tone-map", "samples", "no-background"}},
        {"Goals",
         {"max-error", "bytes-per-vertex", "shader-ops", "seconds", "best-effort", "measure", "check"},
         {"max-jump"}},
        {"Quality",
         {"order", "rays", "target-error", "bounces", "denoise", "fit", "refine", "preset", "lobes", "poses"},
         {"method", "enclosed", "storage", "seed", "clusters", "components", "bits", "predictors",
          "seam-weight"}},
        {"Lamps", {"lamps", "lamp-scale"}, {}},
        {"Materials", {"subsurface", "no-shadow"}, {"metres-per-unit", "back-sides"}},
        {"Occlusion", {"falloff", "max-distance", "bent-normals", "occluders"}, {"attribute"}},
        {"Lightmap and detailed model", {"texels", "high-poly"}, {}},
        {"Volume", {"volume"}, {}},
        {"Instances and levels of detail", {"instances", "levels"}, {"stored-lobes"}},
        {"File", {"combine-direct", "fallback", "reorder", "meshopt"}, {}},
        {"Reading", {}, {"smooth-normals", "bad-textures", "allow-outside", "memory-limit"}},
        {"Program", {"device", "threads", "help", "help-all", "version"}, {}},
    };
    return kGroups;
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
    if (mode == CLI::AppFormatMode::Sub)
        return make_expanded(app);
    const bool is_command = app->get_parent() != nullptr;
    std::string text = make_description(app) + make_usage(app, std::move(name));
    if (is_command)
        text += arguments_of(*app);
    text += groups_of(*app, mode == CLI::AppFormatMode::All) + make_subcommands(app, mode);
    return text +
           (is_command
                ? "\n--help-all lists rare options and explains all values; [brackets] contain defaults\n"
                : "\nprt COMMAND --help lists the options of a command\n");
}

std::string HelpFormatter::make_expanded(const CLI::App* command) const {
    return command->get_name() + ": " + command->get_description() + "\n" + arguments_of(*command) +
           groups_of(*command, true) + "\n";
}

} // namespace prt::cli

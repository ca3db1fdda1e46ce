// Suggests the nearest known command or option.

#include "known_names.h"

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
            if (const auto names = names_of_options(*command); !is_in(names, name))
                refuse("option", name, names);
        } else if (!option && command == &app) {
            const auto names = names_of_commands(app);
            if (!is_in(names, word))
                refuse("command", word, names);
            command = app.get_subcommand(word);
        }
    }
}

} // namespace prt::cli

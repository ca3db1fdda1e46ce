#pragma once

// Options that several commands share.

#include "arguments.h"

#include <CLI/CLI.hpp>

#include <map>
#include <string>

namespace prt::cli {

/// An option whose value is one of `choices`.
template <class T, class Target>
CLI::Option* choice(CLI::App* command, const std::string& name, Target& target,
                    const std::map<std::string, T>& choices, const std::string& text,
                    const std::string& otherwise) {
    std::string names;
    for (const auto& [key, value] : choices)
        names += (names.empty() ? "" : "|") + key;
    return command
        ->add_option_function<std::string>(
            name, [&target, &choices](const std::string& key) { target = choices.at(key); }, text)
        ->check(CLI::IsMember(choices))
        ->type_name(names)
        ->default_str(otherwise);
}

/// -o, --output: the file that a command is for.
void add_output(CLI::App* command, Path& output, const std::string& text);
void add_threads(CLI::App* command, int& threads);
void add_json(CLI::App* command, Path& json);
void add_reports(CLI::App* command, Path& json, Path& html, Path& csv);
void add_light_options(CLI::App* command, LightOptions& options);

void add_compress(CLI::App& app, CompressArguments& arguments);
/// What the options of prt compress mean together: u32 where no size is given, a search where a budget is.
void resolve(const CLI::App& command, CompressArguments& arguments);

} // namespace prt::cli

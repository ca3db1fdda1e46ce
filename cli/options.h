#pragma once

// Options that several commands share, and how a command keeps what its options say.

#include "inputs.h"
#include "prt/bake.h"
#include "reading_options.h"
#include "report/publish.h"

#include <CLI/CLI.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>

namespace prt::cli {

/// What the options of `command` are to fill. It lives as long as the command, which calls `run` with it once
/// all options are parsed.
template <class Arguments, class Run>
Arguments& arguments_for(CLI::App* command, Run run) {
    auto arguments = std::make_shared<Arguments>();
    command->callback([arguments, run] { run(*arguments); });
    return *arguments;
}

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

/// What an argument must be; else it is wrong usage, and the command does not begin.
CLI::Validator real_in(double low, double high); ///< and no NaN
CLI::Validator above_zero();                     ///< and finite
CLI::Validator seed();
/// The error of a file's name, or nothing.
std::string named(const std::string& name);

/// -o, --output: the file that a command is for.
void add_output(CLI::App* command, Path& output, const std::string& text);
/// --allow-outside, --bad-textures and --scene-limit, of every command that reads a scene.
void add_reading(CLI::App* command, ReadingOptions& reading);
/// --smooth-normals
void add_smooth_normals(CLI::App* command, GltfOptions& reading);
void add_threads(CLI::App* command, int& threads);
void add_json(CLI::App* command, Path& json);
void add_reports(CLI::App* command, ReportFiles& files);
CLI::Option* add_backend(CLI::App* command, Backend& backend, const std::string& text);
/// --gpu, of commands that bake on one.
CLI::Option* add_gpu(CLI::App* command, std::string& gpu);
/// Makes a GPU that is named the one to bake on. Throws `Error` where none is used.
void choose_gpu(TracerChoice& tracer);
void add_inside(CLI::App* command, Inside& inside);
/// --fit, which is automatic where it is not given.
void add_fit(CLI::App* command, FitMode& fit, const std::string& text);
void add_light_options(CLI::App* command, LightOptions& options);

/// What `text` says, all of it, in any notation of C; nothing where that is no number.
std::optional<int> whole_number(const std::string& text);
std::optional<double> real_number(const std::string& text);

} // namespace prt::cli

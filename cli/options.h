#pragma once

// Options shared by several commands, and storage for the options of a command.

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

/// Returns the struct that the options of `command` fill. It lives as long as the command, which calls `run`
/// with it after all options are parsed.
template <class Arguments, class Run>
Arguments& arguments_for(CLI::App* command, Run run) {
    auto arguments = std::make_shared<Arguments>();
    command->callback([arguments, run] { run(*arguments); });
    return *arguments;
}

/// Adds an option whose value is one of `choices`.
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

/// Validators of arguments; an invalid value is a usage error, and the command does not start.
CLI::Validator real_in(double low, double high); ///< rejects NaN
CLI::Validator above_zero();                     ///< finite
CLI::Validator seed();
/// Returns the error message for an empty file name; empty if the name is valid.
std::string named(const std::string& name);

/// Adds -o, --output: the main output of a command.
void add_output(CLI::App* command, Path& output, const std::string& text);
/// Adds --allow-outside, --bad-textures and --scene-limit, for every command that reads a scene.
void add_reading(CLI::App* command, ReadingOptions& reading);
/// --smooth-normals
void add_smooth_normals(CLI::App* command, GltfOptions& reading);
void add_threads(CLI::App* command, int& threads);
void add_json(CLI::App* command, Path& json);
void add_reports(CLI::App* command, ReportFiles& files);
CLI::Option* add_backend(CLI::App* command, Backend& backend, const std::string& text);
/// Adds --gpu, for commands that bake on one.
CLI::Option* add_gpu(CLI::App* command, std::string& gpu);
/// Selects the GPU backend if a GPU is named. Throws `Error` if rays are not traced on a GPU.
void choose_gpu(TracerChoice& tracer);
void add_inside(CLI::App* command, Inside& inside);
/// Adds --fit, which is automatic by default.
void add_fit(CLI::App* command, FitMode& fit, const std::string& text);
void add_light_options(CLI::App* command, LightOptions& options);

/// Return the number in `text`, in any notation of C; empty if `text` is not exactly one number.
std::optional<int> whole_number(const std::string& text);
std::optional<double> real_number(const std::string& text);

} // namespace prt::cli

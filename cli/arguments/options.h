#pragma once

// Options shared by several commands, and storage for the options of a command.

#include "cli/pipeline/model.h"
#include "cli/pipeline/reading_options.h"
#include "cli/program/publish.h"
#include "prt/bake/bake.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt::cli {

/// Returns the struct that the options of `command` fill. It lives as long as the command, which calls `run`
/// with it after all options are parsed.
template <class Arguments, class Run>
Arguments& arguments_for(CLI::App* command, Run run) {
    auto arguments = std::make_shared<Arguments>();
    command->callback([arguments, run] { run(*arguments); });
    return *arguments;
}

/// A value that an option can have.
template <class T>
struct Choice {
    const char* name;
    T value;
    const char* explanation;
};

/// Returns "auto|on|off", and the lines that explain the choices in help.
template <class T, std::size_t N>
std::string names_of(const Choice<T> (&choices)[N]) {
    std::string names;
    for (const Choice<T>& choice : choices)
        names += (names.empty() ? "" : "|") + std::string(choice.name);
    return names;
}
template <class T, std::size_t N>
std::string explained(const Choice<T> (&choices)[N]) {
    std::string lines;
    for (const Choice<T>& choice : choices)
        lines += std::string("\n") + choice.name + ": " + choice.explanation;
    return lines;
}

/// Returns the value of the choice called `name`. Throws `CLI::ValidationError` for an unknown name.
template <class T, std::size_t N>
T chosen(const std::string& option, const Choice<T> (&choices)[N], const std::string& name) {
    for (const Choice<T>& choice : choices)
        if (name == choice.name)
            return choice.value;
    throw CLI::ValidationError(option, "'" + name + "' is not one of " + names_of(choices));
}

/// Adds an option whose value is one of `choices`.
template <class T, std::size_t N, class Target>
CLI::Option* choice(CLI::App* command, const std::string& name, Target& target, const Choice<T> (&choices)[N],
                    const std::string& text, const std::string& usual) {
    return command
        ->add_option_function<std::string>(
            name,
            [name, &target, &choices](const std::string& given) { target = chosen(name, choices, given); },
            text + explained(choices))
        ->type_name(names_of(choices))
        ->default_str(usual);
}

/// Validators of arguments. An invalid value is a usage error, and the command does not start.
CLI::Validator real_in(double low, double high); ///< rejects NaN
CLI::Validator above_zero();                     ///< finite
/// Returns the error message for an empty file name; empty if the name is valid.
std::string named(const std::string& name);

/// Adds -o, --output: the main output of a command.
void add_output(CLI::App* command, Path& output, const std::string& text);
/// Adds --allow-outside, --bad-textures and --memory-limit, for every command that reads a scene. `limit`:
/// also gets the limit, in bytes.
void add_reading(CLI::App* command, ReadingOptions& reading, double* limit = nullptr);
/// --smooth-normals
void add_smooth_normals(CLI::App* command, GltfOptions& reading);
void add_threads(CLI::App* command, int& threads);
void add_json(CLI::App* command, Path& json);
void add_reports(CLI::App* command, ReportFiles& files);
/// Adds --device, for commands that trace rays.
CLI::Option* add_device(CLI::App* command, TracerChoice& tracer);
/// Throws `Error` if a GPU is named and rays are not traced on one.
void check_device(const TracerChoice& tracer);
void add_seed(CLI::App* command, std::uint64_t& seed);
/// Adds --enclosed.
void add_enclosed(CLI::App* command, Inside& inside);
/// Adds --fit, which is automatic by default.
void add_fit(CLI::App* command, FitMode& fit, const std::string& text);

/// Return the number in `text`, in any notation of C; empty if `text` is not exactly one number.
std::optional<int> whole_number(const std::string& text);
std::optional<double> real_number(const std::string& text);

} // namespace prt::cli

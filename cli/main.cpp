// The prt program: parses the command line, runs a command and reports errors.

#include "cli/arguments/help.h"
#include "cli/arguments/known_names.h"
#include "cli/commands/commands.h"
#include "cli/pipeline/shell_word.h"
#include "cli/program/session.h"
#include "cli/program/terminal.h"
#include "prt/core/error.h"

#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

namespace prt::cli {
namespace {

/// Returns the command line, quoted for a shell.
std::string command_line(int argc, char** argv) {
    std::string line = "prt";
    for (int i = 1; i < argc; ++i)
        line += " " + shell_word(argv[i]);
    return line;
}

void add_commands(CLI::App& app, Session& session) {
    app.formatter(std::make_shared<HelpFormatter>());
    app.set_help_flag("-h,--help", "print the common options and exit");
    app.set_help_all_flag("--help-all", "print all options with details and exit");
    app.set_version_flag("--version", "prt " PRTKIT_VERSION, "print the version and exit");
    app.require_subcommand(1);
    add_make(app, session);
    add_ao(app, session);
    add_bake(app, session);
    add_bench(app, session);
    add_compress(app, session);
    add_evaluate(app, session);
    add_lobes(app, session);
    add_project(app, session);
    add_relight(app, session);
    add_render(app, session);
    add_shader(app, session);
    add_info(app, session);
}

/// Runs the command. Throws its error, after all threads that could report it have ended.
int run(int argc, char** argv) {
    Session session(command_line(argc, argv));
    CLI::App app("prtkit: bakes, compresses and relights precomputed radiance transfer", "prt");
    add_commands(app, session);
    if (argc < 2) {
        print(app.help());
        throw CLI::ParseError("no command given; the commands are listed above",
                              CLI::ExitCodes::RequiredError);
    }
    check_names(app, {argv + 1, static_cast<std::size_t>(argc - 1)});
    try {
        app.parse(argc, argv); // calls the command
    } catch (const CLI::Success& nothing_to_do) {
        app.exit(nothing_to_do); // prints help
    }
    session.finish();
    return session.status();
}

constexpr const char* kNoMemory = "out of memory";

/// Also where there is no memory left for words.
int complain(int status, std::string_view what, std::string_view more = {}) noexcept {
    try {
        say(std::string("error: ").append(what).append(more));
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "prt: error: %s\n", kNoMemory);
    }
    return status;
}

/// Destructors of JSON allocate memory, and terminate the program if they cannot. Output files have temporary
/// names at this point, which the next run removes.
[[noreturn]] void end_without_memory() {
    const std::exception_ptr error = std::current_exception();
    try {
        if (error)
            std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "prt: error: %s\n", kNoMemory);
        std::_Exit(1);
    } catch (...) {
    }
    std::abort();
}

int run_and_report(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const CLI::ParseError& error) {
        return complain(2, error.what());
    } catch (const Error& error) {
        return complain(1, error.what());
    } catch (const std::bad_alloc&) {
        return complain(1, kNoMemory);
    } catch (const std::length_error&) { // more than there can be
        return complain(1, kNoMemory);
    } catch (const std::filesystem::filesystem_error& error) {
        return complain(1, error.what());
    } catch (const std::exception& error) {
        return complain(1, "internal error, please report it: ", error.what());
    }
}

} // namespace
} // namespace prt::cli

int main(int argc, char** argv) {
    for (const int signal : {SIGPIPE, SIGXFSZ}) // writing fails instead
        std::signal(signal, SIG_IGN);
    std::set_terminate(prt::cli::end_without_memory);
    prt::cli::occupy_standard_streams();
    return prt::cli::run_and_report(argc, argv);
}

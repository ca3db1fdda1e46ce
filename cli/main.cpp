#include "commands/commands.h"
#include "known_names.h"
#include "prt/support/error.h"
#include "session.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <new>
#include <string>

namespace prt::cli {
namespace {

/// As a shell would take it.
std::string command_line(int argc, char** argv) {
    std::string line = "prt";
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool plain =
            !word.empty() && word.find_first_of(" \t\n'\"\\$`*?;&|<>(){}#") == std::string::npos;
        line += plain ? " " + word : " '" + word + "'";
    }
    return line;
}

void add_commands(CLI::App& app, Session& session) {
    app.set_version_flag("--version", "prt " PRTKIT_VERSION);
    app.require_subcommand(1);
    add_bake(app, session);
    add_bench(app, session);
    add_compress(app, session);
    add_evaluate(app, session);
    add_project(app, session);
    add_render(app, session);
    add_shader(app, session);
    add_info(app, session);
}

int complain(int status, const char* what) {
    fmt::print(stderr, "prt: error: {}\n", what);
    return status;
}

} // namespace
} // namespace prt::cli

int main(int argc, char** argv) {
    using namespace prt::cli;
    Session session(command_line(argc, argv));
    CLI::App app("prtkit: bakes, compresses and relights precomputed radiance transfer", "prt");
    add_commands(app, session);
    if (argc < 2) {
        fmt::print("{}", app.help());
        return complain(2, "which command? They are listed above");
    }
    try {
        check_names(app, {argv + 1, static_cast<std::size_t>(argc - 1)});
        app.parse(argc, argv); // calls the command
        if (std::fflush(stdout) != 0)
            throw prt::Error("standard output cannot be written");
        return 0;
    } catch (const CLI::Success& nothing_to_do) {
        return app.exit(nothing_to_do);
    } catch (const CLI::ParseError& error) {
        return complain(2, error.what());
    } catch (const std::bad_alloc&) {
        return complain(1, "there is not enough memory");
    } catch (const std::exception& error) {
        return complain(1, error.what());
    }
}

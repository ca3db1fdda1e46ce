#pragma once

namespace CLI {
class App;
}

namespace prt::cli {

class Session;

// Declares one function per command, which adds the command with its options and its action. A command throws
// `Error` if it cannot do its work, and `CLI::ParseError` for options that cannot be combined.
void add_ao(CLI::App& app, Session& session);
void add_bake(CLI::App& app, Session& session);
void add_bench(CLI::App& app, Session& session);
void add_compress(CLI::App& app, Session& session);
void add_evaluate(CLI::App& app, Session& session);
void add_info(CLI::App& app, Session& session);
void add_lobes(CLI::App& app, Session& session);
void add_make(CLI::App& app, Session& session);
void add_project(CLI::App& app, Session& session);
void add_relight(CLI::App& app, Session& session);
void add_render(CLI::App& app, Session& session);
void add_shader(CLI::App& app, Session& session);

} // namespace prt::cli

#pragma once

namespace CLI {
class App;
}

namespace prt::cli {

class Session;

// Each declares one command: its options, and what it does with them once they are parsed. A command throws
// `Error` when it cannot do its work, and `CLI::ParseError` for options that do not go together.
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

// prt compress: compresses transfer of vertices, textures, volumes or instances.

#include "cli/arguments/compress_arguments.h"
#include "cli/arguments/light_arguments.h"
#include "cli/arguments/options.h"
#include "cli/commands/commands.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"

namespace prt::cli {
namespace {

std::vector<Path> check_files(const CompressArguments& a) {
    std::vector<Path> inputs = a.metric.lights;
    inputs.insert(inputs.end(), {a.baked.path, a.writing.fallback});
    return check_outputs(
        {{a.output, "--output", {".glb"}}, {a.json, "--json", {".json"}}, {a.trace, "--trace", {".jsonl"}}},
        inputs);
}

void run(CompressArguments a, Session& session) {
    a.reading.outputs = check_files(a);
    Report report = compress_model(a, session.host());
    publish(report, a.json, session);
}

} // namespace

void add_compress(CLI::App& app, Session& session) {
    CLI::App* command = app.add_subcommand("compress", "Compress a bake by clustered PCA");
    auto& a = arguments_for<CompressArguments>(command, [command, &session](CompressArguments& given) {
        check_light_options(*command, !given.metric.lights.empty() || !given.writing.fallback.empty());
        resolve(*command, given);
        run(given, session);
    });
    command
        ->add_option("baked", a.baked.path,
                     "bake to compress: output of prt bake, or of prt make --keep-bake")
        ->required()
        ->check(named);
    add_output(command, a.output, "write the compressed model to this file, .glb");
    add_options(command, a);
}

} // namespace prt::cli

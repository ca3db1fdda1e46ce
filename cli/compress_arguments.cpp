#include "argument_parts.h"

namespace prt::cli {
namespace {

const std::map<std::string, WeightFormat> kWeights = {{"packed", WeightFormat::packed},
                                                      {"float", WeightFormat::float32},
                                                      {"16", WeightFormat::snorm16},
                                                      {"8", WeightFormat::snorm8}};
const std::map<std::string, MetricChoice> kMetrics = {{"natural", MetricChoice::natural},
                                                      {"plain", MetricChoice::plain}};

/// A number, or auto: the search chooses.
void count_or_auto(CLI::App* command, const std::string& name, int& target, bool& choose,
                   const std::string& text) {
    command
        ->add_option_function<std::string>(
            name,
            [name, &target, &choose](const std::string& value) {
                choose = value == "auto";
                if (!choose && !CLI::detail::lexical_cast(value, target))
                    throw CLI::ValidationError(name, "'" + value + "' is neither a number nor auto");
            },
            text)
        ->type_name("N|auto");
}

void add_sizes(CLI::App* command, SearchOptions& o) {
    command
        ->add_option_function<std::string>(
            "--preset",
            [&o](const std::string& name) {
                if (name != "custom")
                    o.compress.coding = name == "u32" ? preset_u32() : preset_u64();
            },
            "u32: all of a vertex in one 32-bit word; u64: in two; both with 256 clusters, or as many as "
            "bases of twice those bytes (or 4 KB) hold; custom: as the following options say")
        ->check(CLI::IsMember({"u32", "u64", "custom"}))
        ->type_name("u32|u64|custom")
        ->default_str("u32, custom with other sizes");
    count_or_auto(command, "--clusters", o.compress.clusters, o.choose_clusters,
                  "number of clusters, 1..65536");
    count_or_auto(command, "--components", o.compress.coding.components, o.choose_components,
                  "most PCA components of a cluster");
    command->add_option("--bits", o.compress.coding.bits,
                        "bits of a vertex's weights together, where they are packed");
    choice(command, "--weights", o.compress.coding.format, kWeights,
           "packed: bits by variance; or 8 or 16 bits each, or float", "packed");
    command->add_option("--max-error", o.budget.max_error,
                        "the cheapest whose expected lit_rms under the metric is at most this");
    command->add_option("--bytes-per-vertex", o.budget.bytes_per_vertex,
                        "the best of at most this size: whole 32-bit words, as a game binds them, and bases");
    command->add_option("--shader-ops", o.budget.mean_components,
                        "components that the vertex shader adds, on average over the vertices, at most");
}

} // namespace

void add_compress(CLI::App& app, CompressArguments& a) {
    CLI::App* command = app.add_subcommand("compress", "Compress a bake by clustered PCA");
    command->add_option("baked", a.baked, "output of prt bake")->required();
    add_output(command, a.output, "compressed .glb to write");
    add_sizes(command, a.options);
    command->add_flag("--best-effort", a.best_effort, "write the nearest where nothing keeps the budget");
    CLI::Option* metric =
        choice(command, "--metric", a.metric, kMetrics,
               "what an error costs: natural lighting from any side, or all coefficients alike", "natural");
    command
        ->add_option(
            "--lights", a.lights,
            "compress for this environment (.exr, .hdr, .png, .jpg) or light (.json), turned about +Y; "
            "repeat it for each of several")
        ->allow_extra_args(false) // one each time, so that the bake may follow
        ->excludes(metric)
        ->type_name("FILE");
    add_light_options(command, a.light_options);
    command
        ->add_option("--seam-weight", a.options.compress.seam_price,
                     "what jumps of the error along mesh edges cost, 0: nothing")
        ->capture_default_str();
    command
        ->add_option("--potts-weight", a.options.compress.border_price,
                     "price of a neighbour in another cluster, in mean squared errors")
        ->capture_default_str();
    command->add_flag("--reorder", a.reorder, "put the vertices of a cluster side by side");
    command->add_flag("--meshopt", a.meshopt, "write vertex data through EXT_meshopt_compression");
    command->add_option("--seed", a.options.compress.seed, "seed of the clustering")->capture_default_str();
    add_threads(command, a.options.compress.threads);
    add_json(command, a.json);
}

void resolve(const CLI::App& command, CompressArguments& a) {
    SearchOptions& o = a.options;
    const auto given = [&](const char* name) { return command.count(name) > 0; };
    const bool sizes = given("--clusters") || given("--components") || given("--bits") || given("--weights");
    const bool preset = given("--preset") && command.get_option("--preset")->as<std::string>() != "custom";
    if (preset && (sizes || o.budget.any()))
        throw CLI::ValidationError("--preset", "u32 and u64 fix what other sizes and budgets would choose");
    a.components_given = given("--components");
    a.preset = preset || (!o.budget.any() && !sizes && !given("--preset"));
    if (o.budget.any()) {
        if (given("--bits"))
            throw CLI::ValidationError("--bits", "is what a budget chooses");
        o.choose_clusters = o.choose_clusters || !given("--clusters");
        o.choose_components = o.choose_components || !given("--components");
        return;
    }
    if ((given("--clusters") && o.choose_clusters) || (given("--components") && o.choose_components))
        throw CLI::ValidationError("auto", "needs --max-error, --bytes-per-vertex or --shader-ops");
    if (!preset && !sizes && !given("--preset")) {
        o.compress.coding = preset_u32();
        return;
    }
    if (preset || o.compress.coding.format == WeightFormat::packed)
        return;
    if (!given("--components"))
        o.compress.coding.components = 8;
    a.preset = !given("--clusters"); // as many as suit the mesh
}

} // namespace prt::cli

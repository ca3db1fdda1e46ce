// Adds and resolves the options of prt compress.

#include "cli/arguments/compress_arguments.h"

#include "cli/arguments/light_arguments.h"
#include "cli/arguments/options.h"
#include "cli/arguments/suboptions.h"
#include "compress/metric/jumps.h"

#include <fmt/core.h>

#include <map>

namespace prt::cli {
namespace {

const std::map<std::string, WeightCoding (*)()> kPresets = {
    {"u32", preset_u32}, {"u64", preset_u64}, {"u32x4", preset_u32x4}, {"u64x9", preset_u64x9}};
constexpr Choice<PredictorChoice> kPredictors[] = {
    {"none", PredictorChoice::none, "no prediction; components represent all transfer"},
    {"normal", PredictorChoice::normal,
     "a linear function of the normal in each cluster; components represent the rest"},
    {"position", PredictorChoice::normal_and_position, "a linear function of the normal and the position"}};

struct CountRange {
    int low, high;
};

/// A number, or auto: the search chooses.
void count_or_auto(CLI::App* command, const std::string& name, CountRange range, int& target, bool& choose,
                   const std::string& text) {
    command
        ->add_option_function<std::string>(
            name,
            [name, range, &target, &choose](const std::string& value) {
                choose = value == "auto";
                const std::optional<int> number = choose ? target : whole_number(value);
                if (!number || (!choose && (*number < range.low || *number > range.high)))
                    throw CLI::ValidationError(name,
                                               fmt::format("'{}' is neither a number in {}..{} nor auto",
                                                           value, range.low, range.high));
                target = *number;
            },
            text)
        ->type_name("N|auto");
}

void set_bits(const std::string& text, WeightCoding& coding) {
    if (text == "float") {
        coding.format = WeightFormat::float32;
        return;
    }
    const std::optional<int> bits = whole_number(text);
    if (!bits || *bits < 0 || *bits > kMaxPackedBits)
        throw CLI::ValidationError(
            "--bits", fmt::format("'{}' is neither a number in 0..{} nor float", text, kMaxPackedBits));
    coding.format = WeightFormat::packed;
    coding.bits = *bits;
}

void add_preset(CLI::App* command, SearchOptions& o) {
    command
        ->add_option_function<std::string>(
            "--preset",
            [&o](const std::string& name) {
                if (name != "custom")
                    o.compress.coding = kPresets.at(name)();
            },
            "size and layout of the compressed data of a vertex\n"
            "u32: one 32-bit word; clusters have different numbers of components\n"
            "u64: two 32-bit words, with clusters like those of u32\n"
            "u32x4: one 32-bit word, four components in each cluster; for shaders without a loop\n"
            "u64x9: two 32-bit words, nine components in each cluster; for shaders without a loop\n"
            "custom: sizes from --clusters, --components and --bits, or chosen for a goal\n"
            "  default if one of these options or a goal is given\n"
            "  goals: --max-error, --bytes-per-vertex and --shader-ops\n"
            "all except custom: up to 256 clusters; fewer for small meshes and lightmaps:\n"
            "  bases need at most twice the bytes of vertices or texels, or 4096 bytes if that is more\n"
            "  u32x4 and u64x9 then have the clusters of u32 and u64: shaders need a loop\n"
            "presets except custom cannot be combined with goals, --clusters, --components and --bits")
        ->check(CLI::IsMember({"u32", "u64", "u32x4", "u64x9", "custom"}))
        ->type_name("u32|u64|u32x4|u64x9|custom")
        ->default_str("u32");
    count_or_auto(command, "--clusters", {1, 65536}, o.compress.clusters, o.choose_clusters,
                  "limit of clusters, 1 to 65536; default: 256, or auto with a goal\n"
                  "auto: chosen for a goal, which it needs: --max-error, --bytes-per-vertex or --shader-ops\n"
                  "not with a --preset other than custom; no effect on the probes of a volume\n"
                  "with --bits float, the default is lower for small meshes, as with presets");
    count_or_auto(
        command, "--components", {0, 3 * coefficient_count(kMaxOrder)}, o.compress.coding.components,
        o.choose_components,
        "limit of components per cluster; default: 16, or auto with a goal\n"
        "auto: chosen for the goal, which it needs: --max-error, --bytes-per-vertex or --shader-ops\n"
        "PCA components, 0 to 300; more than the coefficients of a vertex or texel are an error\n"
        "without --bits float at most 16 are used\n"
        "default with --bits float and without a goal: 8\n"
        "not with --preset, except --preset custom");
    command
        ->add_option_function<std::string>(
            "--bits", [&o](const std::string& text) { set_bits(text, o.compress.coding); },
            "bits of all weights of a vertex or texel, 0 to 240; default: 24\n"
            "N and the bits of the cluster index together are rounded up to whole 32-bit words\n"
            "with a goal, N is chosen, and only float can be given; not with a --preset other than custom\n"
            "float: 32-bit weights, not quantized; shows the error of quantization by comparison\n"
            "  not for lightmaps")
        ->type_name("N|float");
    choice(command, "--predictors", o.compress.predictors, kPredictors,
           "vertex attributes that predict transfer\n"
           "with a goal, the default is the best of the three; lightmaps: only none, the default",
           "normal");
}

void set_max_jump(const std::string& value, Budget& budget) {
    if (value == "none")
        return;
    if (const std::string wrong = above_zero()(value); !wrong.empty())
        throw CLI::ValidationError("--max-jump", wrong + ", nor none");
    budget.max_jump = real_number(value);
}

void add_goals(CLI::App* command, SearchOptions& o) {
    command
        ->add_option(
            "--max-error", o.budget.max_error,
            "find the fewest bytes per vertex with at most this relative L2 error\n"
            "X: error of the lit surface, above 0; 0.01: 1 %; not of the probes of a volume\n"
            "  for each sky of --lights at every rotation about +Y, with its suns in the sky, and if\n"
            "  the result has direct and indirect transfer, also separate (without their direct light)\n"
            "  natural and plain: on average over the light\n"
            "X also limits the contrast error, which is relative to the local brightness:\n"
            "  a root mean square over all skies, and one over all lamps with one lamp lit at a time\n"
            "as the only goal it also sets --max-jump 0.05; an error if no result meets the goals\n"
            "default: no limit")
        ->check(above_zero());
    command
        ->add_option_function<std::string>(
            "--max-jump", [&o](const std::string& value) { set_max_jump(value, o.budget); },
            "limit of jumps of the contrast error between clusters\n"
            "X: difference between both sides of a border, relative to the local brightness\n"
            "  above 0; 0.05: 5 %; 99 % of the borders keep it\n"
            "each FILE of --lights keeps it at 24 rotations; a FAMILY of --lights on average\n"
            "none: no limit\n"
            "X needs another goal; default: 0.05 if --max-error is the only other goal, else none")
        ->type_name("X|none")
        ->default_str(fmt::format("{} or none", kUnseenJump));
    command
        ->add_option(
            "--bytes-per-vertex", o.budget.bytes_per_vertex,
            "find the minimum error with at most X bytes per vertex, with bases\n"
            "X: the bytes of its 32-bit words, plus the bytes of all bases / number of vertices or texels\n"
            "  above 0; an error if no result has at most X bytes (see --best-effort)\n"
            "error: the larger of relative L2 and contrast error (see --max-error), mean over --lights\n"
            "with --max-error: only an additional limit; default: no limit\n"
            "with --shader-ops: the result keeps both limits; probes of a volume are not limited\n"
            "not with --bits N or a --preset other than custom")
        ->check(above_zero());
    command
        ->add_option("--shader-ops", o.budget.operations,
                     "limit of the mean number of multiply-adds per vertex or texel\n"
                     "X: above 0; one multiply-add of a color for each component, plus those of\n"
                     "  --predictors: none: 0, normal: 3, position: 6\n"
                     "without --max-error: find the minimum error; default: no limit\n"
                     "with --max-error or --bytes-per-vertex: an additional limit\n"
                     "not with --bits N or a --preset other than custom")
        ->check(above_zero());
}

/// Adds options of the written file.
void add_writing(CLI::App* command, CompressArguments& a) {
    command->add_flag(
        "--combine-direct", a.writing.whole,
        "merge direct and indirect transfer: fewer bytes, no sharp sun shadows\n"
        "suns become part of the sky, with soft shadows only; lamps and volumes are not merged\n"
        "default: separate; a renderer can then draw sharp shadows of suns");
    command
        ->add_option(
            "--fallback", a.writing.fallback,
            std::string(
                "add vertex colors, lit by this file, for viewers without PRT support\n"
                "not for lightmaps and shared instances; default: no vertex colors are added\n"
                "exposure is automatic; suns are part of the sky; lamps are as bright as in the bake\n"
                "materials become unlit; emissive, glass and unlit ones remain as they are\n"
                "programs that read the transfer restore the original colors and materials\n") +
                kLightFiles + "\nlight file: at least of the order of the bake")
        ->check(named)
        ->type_name("FILE");
    command->add_flag("--reorder", a.writing.reorder,
                      "store the vertices of a cluster together; default: order of the bake\n"
                      "changes the order inside each mesh, not the picture; not for lightmaps");
    command->add_flag(
        "--meshopt", a.writing.meshopt,
        "compress the file with EXT_meshopt_compression; default: off\n"
        "lossless, for vertices and triangles; programs that read the file need this extension\n"
        "not for images, and not for the weights of lightmaps and volumes\n"
        "also entropy-codes the weights of vertices if this is smaller, not with --bits float\n"
        "  your readers must then decode them as docs/format.md describes; those of prtkit do\n"
        "the bytes in GPU memory remain the same");
}

/// Adds --volume.
void add_probe_size(CLI::App* command, CompressArguments& a) {
    Suboptions("--volume", "",
               "size of the probes, as --volume bytes=12; needs a bake with a volume\n"
               "goals, --preset and the other sizes have no effect on probes",
               nullptr)
        .key("bytes", "N",
             "bytes per probe: 4, 8, 12, 16, 20, 24 or 28 [16]\n"
             "  without the bases, and without 6 bytes per probe of visibility distances",
             [&a](const std::string& text) {
                 const std::optional<int> bytes = whole_number(text);
                 if (!bytes || *bytes < 4 || *bytes > 28 || *bytes % 4 != 0)
                     throw CLI::ValidationError("--volume",
                                                "bytes=" + text + ": expected a multiple of 4 from 4 to 28");
                 a.volume_bytes = *bytes;
             })
        .add(command);
}

} // namespace

void add_options(CLI::App* command, CompressArguments& a) {
    add_preset(command, a.options);
    add_goals(command, a.options);
    command->add_flag(
        "--best-effort", a.best_effort,
        "write the closest result if no result meets the goals; default: error\n"
        "goals: --max-error, --bytes-per-vertex, --shader-ops, --max-jump; no effect without a goal");
    add_metric(command, a.metric);
    command
        ->add_option(
            "--seam-weight", a.options.compress.seam_weight,
            "weight of error jumps along mesh edges; 0: jumps are ignored\n"
            "0 to 1000000, relative to the weight of the error; larger: fainter borders of clusters\n"
            "lightmaps: jumps between adjacent texels and across UV seams\n"
            "no effect on the probes of a volume")
        ->capture_default_str()
        ->check(real_in(0, kMaxSeamWeight));
    add_writing(command, a);
    add_probe_size(command, a);
    add_seed(command, a.options.compress.seed);
    add_reading(command, a.reading);
    add_threads(command, a.options.compress.threads);
    command
        ->add_option(
            "--trace", a.trace,
            "log the steps of the compressor to this file; default: no log\n"
            "one JSON object per line; event: seeded (initial clusters), clustering_round, split, merge,\n"
            "  moves (splits and merges kept or reverted), coding_round, trial (one trial of a search)\n"
            "no lines about probes of a volume; no file is written if the compression fails")
        ->check(named)
        ->type_name("FILE.jsonl");
    add_json(command, a.json);
}

void resolve(const CLI::App& command, CompressArguments& a) {
    SearchOptions& o = a.options;
    const auto given = [&](const char* name) { return command.count(name) > 0; };
    const bool floats = o.compress.coding.format == WeightFormat::float32;
    const bool sizes = given("--clusters") || given("--components") || given("--bits");
    const bool preset = given("--preset") && command.get_option("--preset")->as<std::string>() != "custom";
    if (preset && (sizes || o.budget.any()))
        throw CLI::ValidationError("--preset", "cannot be combined with other sizes or goals");
    a.components_given = given("--components");
    a.predictors_given = given("--predictors");
    a.preset = preset || (!o.budget.any() && !sizes && !given("--preset"));
    if (o.budget.max_error && !given("--max-jump") && !o.budget.bytes_per_vertex && !o.budget.operations)
        o.budget.max_jump = kUnseenJump;
    if (o.budget.any()) {
        o.choose_predictors = !given("--predictors");
        if (given("--bits") && !floats)
            throw CLI::ValidationError("--bits", "cannot be combined with a goal, which chooses the bits");
        o.choose_clusters = o.choose_clusters || !given("--clusters");
        o.choose_components = o.choose_components || !given("--components");
        return;
    }
    if ((given("--clusters") && o.choose_clusters) || (given("--components") && o.choose_components))
        throw CLI::ValidationError(given("--clusters") && o.choose_clusters ? "--clusters auto"
                                                                            : "--components auto",
                                   "needs --max-error, --bytes-per-vertex or --shader-ops");
    if (!preset && !sizes && !given("--preset")) {
        o.compress.coding = preset_u32();
        return;
    }
    if (preset || !floats)
        return;
    if (!given("--components"))
        o.compress.coding.components = 8;
    a.preset = !given("--clusters"); // the preset's number of clusters is fitted to the mesh
}

} // namespace prt::cli

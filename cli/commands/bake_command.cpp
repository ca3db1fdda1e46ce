#include "commands/commands.h"

#include "light_set.h"
#include "no_shadow.h"
#include "options.h"
#include "outputs.h"
#include "prt/encode_glb.h"
#include "prt/sh.h"
#include "prt/support/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>

namespace prt::cli {
namespace {

struct BakeArguments {
    Path scene, output, json, light_set;
    std::vector<std::string> no_shadow; ///< names of materials
    BakeOptions options;
    GltfOptions reading;
};

const std::map<std::string, Inside> kInsides = {{"refill", Inside::refill}, {"keep", Inside::keep}};
const std::map<std::string, FitMode> kFits = {
    {"auto", FitMode::automatic}, {"vertex", FitMode::vertex}, {"surface", FitMode::surface}};
const std::map<std::string, BakeMethod> kBakeMethods = {{"trace", BakeMethod::trace},
                                                        {"raster", BakeMethod::raster}};
const std::map<std::string, std::optional<TransferStorage>> kStorages = {
    {"auto", std::nullopt}, {"float32", TransferStorage::float32}, {"float16", TransferStorage::float16}};
const std::map<std::string, LampMode> kLampModes = {
    {"all", LampMode::all}, {"indirect", LampMode::indirect}, {"none", LampMode::none}};
const std::map<std::string, BadTextures> kBadTextures = {{"error", BadTextures::error},
                                                         {"ignore", BadTextures::ignore}};

int parse_bounces(const std::string& text) {
    if (text == "inf")
        return kEndlessBounces;
    const std::optional<int> bounces = whole_number(text);
    if (!bounces || *bounces < 0 || *bounces > kMostBounces)
        throw CLI::ValidationError(
            "--bounces",
            fmt::format("'{}' is neither a number of bounces in 0..{} nor inf", text, kMostBounces));
    return *bounces;
}

constexpr double kPerMillimetre = 1000; ///< in 1/m

/// Whether all three are, and none is NaN.
bool all_in(const glm::dvec3& v, double low, double high) {
    return v.x >= low && v.x <= high && v.y >= low && v.y <= high && v.z >= low && v.z <= high;
}

/// [MATERIAL=]MEDIUM, where MEDIUM is a name or six coefficients in 1/mm.
MediumChoice parse_medium(const std::string& text) {
    MediumChoice choice;
    const std::size_t equals = text.rfind('=');
    if (equals != std::string::npos)
        choice.material = text.substr(0, equals);
    const std::string medium = equals == std::string::npos ? text : text.substr(equals + 1);
    std::string names;
    for (const NamedMedium& named : measured_media()) {
        if (named.name == medium) {
            choice.medium = named.medium;
            return choice;
        }
        names += std::string(named.name) + ", ";
    }
    glm::dvec3 &s = choice.medium.scattering, &a = choice.medium.absorption;
    int used = 0;
    if (std::sscanf(medium.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf%n", &s.x, &s.y, &s.z, &a.x, &a.y, &a.z, &used) !=
            6 ||
        static_cast<std::size_t>(used) != medium.size() ||
        !all_in(s * kPerMillimetre, kLeastScattering, kMostCoefficient) ||
        !all_in(a * kPerMillimetre, 0, kMostCoefficient))
        throw CLI::ValidationError("--subsurface",
                                   "'" + medium + "' is neither one of " + names +
                                       "nor six coefficients sr,sg,sb,ar,ag,ab in 1/mm, scattering "
                                       "from 1e-12 and none above 1e6");
    s *= kPerMillimetre;
    a *= kPerMillimetre;
    return choice;
}

void add_transport(CLI::App* command, BakeOptions& options) {
    command
        ->add_option_function<std::string>(
            "--bounces", [&options](const std::string& text) { options.bounces = parse_bounces(text); },
            "bounces of light between surfaces; inf: all of them")
        ->type_name("N|inf")
        ->default_str("0");
    command
        ->add_option_function<std::vector<std::string>>(
            "--subsurface",
            [&options](const std::vector<std::string>& texts) {
                for (const std::string& text : texts)
                    options.subsurface.media.push_back(parse_medium(text));
            },
            "light spreads under the surface of a material, or of all: marble, skin1, whole-milk and others, "
            "or "
            "reduced scattering and absorption sr,sg,sb,ar,ag,ab in 1/mm")
        ->allow_extra_args(false) // one each time, so that the scene may follow
        ->type_name("[MATERIAL=]MEDIUM");
    command
        ->add_option("--metres-per-unit", options.subsurface.metres_per_unit,
                     "size of the scene's unit, where it is not glTF's metre; only media care")
        ->capture_default_str()
        ->check(real_in(1e-9, 1e9));
    choice(command, "--bad-textures", options.repairs.bad_textures, kBadTextures,
           "textures that are missing, damaged or of a format that is not read: stop where one is needed, or "
           "use the factors of their materials alone",
           "error");
    command
        ->add_option_function<std::uint64_t>(
            "--memory-limit",
            [&options](const std::uint64_t& bytes) {
                if (bytes > std::uint64_t{1} << 60) // what a negative number is taken for
                    throw CLI::ValidationError("--memory-limit", "is no size that memory can have");
                options.memory.limit = static_cast<double>(bytes);
            },
            "bytes that the bake may take; otherwise what the machine or its container has")
        ->transform(CLI::AsSizeValue(true))
        ->type_name("SIZE, as 8GB");
    choice(command, "--inside", options.repairs.inside, kInsides,
           "vertices that lie inside solid geometry, where no light comes: they take the light of their "
           "neighbours, "
           "or stay dark",
           "refill");
}

/// NAME=PATTERN
LampGroup parse_group(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
        throw CLI::ValidationError("--lamp-group", "'" + text + "' is not NAME=PATTERN");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

void add_lamps(CLI::App* command, LampOptions& lamps) {
    choice(command, "--lamps", lamps.mode, kLampModes,
           "light of the scene's lamps and of materials that shine: all of it; bounces alone, for renderers "
           "that shadow lamps themselves; or none",
           "all");
    command
        ->add_option_function<std::vector<std::string>>(
            "--lamp-group",
            [&lamps](const std::vector<std::string>& texts) {
                for (const std::string& text : texts)
                    lamps.groups.push_back(parse_group(text));
            },
            "lamps that are dimmed together: those whose name matches, * standing for any letters")
        ->allow_extra_args(false)
        ->type_name("NAME=PATTERN");
    command
        ->add_option("--lamp-radius", lamps.radius,
                     "radius of points and spots, metres: the larger, the softer their shadows")
        ->capture_default_str()
        ->check(real_in(0, 1e9));
    command->add_option("--lamp-rays", lamps.rays, "rays from a vertex to the lamps of a name with extent")
        ->capture_default_str()
        ->check(CLI::Range(1, kMostRays));
}

void add_method(CLI::App* command, BakeOptions& options) {
    add_backend(command, options.tracer.backend,
                "gpu: OpenGL 4.5 of any kind; auto: a hardware GPU, else the CPU");
    options.fit = FitMode::automatic;
    choice(command, "--fit", options.fit, kFits,
           "where light is measured: at vertices; over the surface between them, so that the values of "
           "vertices come nearest to it where they are interpolated; auto: as points between vertices tell",
           "auto");
    choice(command, "--method", options.tracer.method, kBakeMethods,
           "trace: rays; raster: depth maps from many directions, direct light only, on the GPU", "trace");
    command
        ->add_option("--raster-resolution", options.tracer.raster_resolution,
                     "texels along each side of a depth map")
        ->capture_default_str()
        ->check(CLI::Range(16, 16384));
}

Json statistics_json(const BakeStatistics& s) {
    return {{"receivers", s.receivers.all},
            {"receivers_traced", s.receivers.traced},
            {"back_sides", s.receivers.back_sides},
            {"receivers_sealed", s.receivers.sealed},
            {"receivers_refilled", s.receivers.refilled},
            {"rays", s.rays},
            {"device", s.device},
            {"seconds", s.seconds.all},
            {"seconds_build", s.seconds.build},
            {"seconds_trace", s.seconds.tracing.trace},
            {"seconds_accumulate", s.seconds.tracing.accumulate},
            {"seconds_transfer", s.seconds.tracing.transfer},
            {"seconds_transport", s.seconds.transport},
            {"rays_per_second", s.rays_per_second()},
            {"mean_visibility", s.mean_visibility},
            {"sampling_error_relative_l2", s.sampling_error},
            {"float16_error_relative_l2", s.rounding_error},
            {"remaining_energy", s.remaining_energy},
            {"fit", s.fit.samples > 0 ? "surface" : "vertex"},
            {"samples_per_receiver", s.fit.samples},
            {"interpolation_error_relative_l2", s.fit.between},
            {"lamps", s.lamps.count},
            {"lamp_lights", s.lamps.lights},
            {"lamp_triangles", s.lamps.triangles},
            {"gather_entries", s.gather.entries},
            {"gather_bytes", s.gather.bytes},
            {"notices", s.notices}};
}

constexpr double kDark = 0.05; ///< mean visibility; a cellar with a window has as much

/// What the statistics say in words.
void add_sentences(const BakeArguments& a, const BakeResult& result, Report& report) {
    const BakeStatistics& s = result.statistics;
    const bool raster = a.options.tracer.method == BakeMethod::raster;
    const auto say = [&](std::string sentence) { report.sentences.push_back(std::move(sentence)); };
    say(fmt::format("{{output}}: {{receivers}} receivers, {{triangles}} triangles, order {{order}}, "
                    "{}, {{bake/rays_per_receiver}} {} each, {{bake/bounces}} bounces",
                    parts_in_words(result.baked.transfer.layout), raster ? "directions" : "rays"));
    say(fmt::format("{} on the {}: {{device}}", raster ? "depth maps" : "rays",
                    result.baked.record.backend == Backend::cpu ? "CPU" : "GPU"));
    if (s.receivers.all > s.receivers.traced)
        say(fmt::format("{} receivers are on no surface and have zero transfer",
                        s.receivers.all - s.receivers.traced));
    for (std::size_t i = 0; i < s.notices.size(); ++i)
        say(fmt::format("{{notices/{}}}", i));
    say(fmt::format("{{seconds:.3f}} s: build {{seconds_build:.3f}}, trace {{seconds_trace:.3f}}, accumulate "
                    "{{seconds_accumulate:.3f}}, transfer {{seconds_transfer:.3f}}, transport "
                    "{{seconds_transport:.3f}}; {{rays_per_second:.2fM}} million {}/s",
                    raster ? "tests" : "rays"));
    if (a.options.target_error)
        say("error of the direct light: {target_error_relative_l2:.3f%} asked for, "
            "{sampling_error_relative_l2:.3f%} estimated");
    else if (s.sampling_error > 0)
        say("error of the direct light: {sampling_error_relative_l2:.3f%} estimated");
    if (s.fit.between > 0 || s.fit.samples > 0)
        say(fmt::format(
            "between vertices direct light would err by {{interpolation_error_relative_l2:.3f%}}: {}",
            s.fit.samples > 0 ? "vertices are fitted to {samples_per_receiver} samples of the surface each"
                              : "it is measured at vertices"));
    if (s.gather.entries > 0)
        say("bounces: {gather_entries} pairs of receivers that light each other, {gather_bytes:.1fM} MB; at "
            "most {remaining_energy:.2g%} of a receiver's light is missing");
    if (s.lamps.count > 0)
        say("lamps: {lamps}, of {lamp_lights} lights and {lamp_triangles} triangles that shine");
    say("{mean_visibility:.1f%} of the light of a uniform sky arrives, on average");
    if (s.mean_visibility < kDark && a.no_shadow.empty() && s.lamps.count == 0)
        say("hardly any light comes in: where a shell round the scene, as an outline or a sky, keeps it out, "
            "--no-shadow MATERIAL lets it pass");
}

Report report_of(const BakeArguments& a, const BakeResult& result, const Scene& scene, std::uintmax_t bytes) {
    Report report;
    add_figures(report, {{"output", a.output.string()},
                         {"order", a.options.order},
                         {"channels", result.baked.transfer.layout.channels()},
                         {"parts", parts_figures(result.baked.transfer.layout)},
                         {"storage", to_string(result.baked.storage)},
                         {"bake", bake_record_json(result.baked.record)}});
    if (a.options.target_error)
        add_figures(report, {{"target_error_relative_l2", *a.options.target_error}});
    Json statistics = statistics_json(result.statistics);
    statistics["triangles"] = scene.triangles();
    for (const std::string& notice : scene.notices)
        statistics["notices"].push_back(notice);
    add_figures(report, statistics);
    add_figures(report, {{"bytes_file", bytes}});
    add_sentences(a, result, report);
    return report;
}

BakeResult baked(const BakeArguments& a, Scene& scene, Session& session) {
    leave_out_shadows(scene, a.no_shadow);
    ProgressBar bar = session.progress_bar("baking");
    return bake(scene, a.options, bar.progress());
}

void run(BakeArguments a, Session& session) {
    a.reading.outputs = check_outputs({{a.output, "--output", {".glb"}}, {a.json, "--json", {".json"}}},
                                      {a.scene, a.light_set});
    GltfOptions reading = a.reading;
    reading.missing_images =
        a.options.repairs.bad_textures == BadTextures::ignore ? MissingImages::ignore : MissingImages::error;
    GltfDocument document = load_gltf(a.scene, reading);
    Scene scene = extract_scene(document);
    print_notices(a.scene.string(), scene.notices);
    if (!a.light_set.empty())
        std::ranges::move(read_light_set(a.light_set), std::back_inserter(scene.lights));
    const BakeResult result = about(a.scene, [&] { return baked(a, scene, session); });
    const std::vector<std::byte> file = about(a.scene, [&] {
        write_transfer(document, scene, result.baked);
        return encode_glb(document);
    });
    publish(report_of(a, result, scene, session.write(a.output, file)), a.json, session);
}

} // namespace

void add_bake(CLI::App& app, Session& session) {
    CLI::App* command = app.add_subcommand("bake", "Bake transfer vectors for every vertex of a glTF scene");
    auto& a = arguments_for<BakeArguments>(command,
                                           [&session](const BakeArguments& given) { run(given, session); });
    command->add_option("scene", a.scene, "glTF 2.0 scene, .gltf or .glb")->required()->check(named);
    add_output(command, a.output, "baked .glb to write");
    command->add_option("--order", a.options.order, "SH order N, 1..10: N² coefficients")
        ->capture_default_str()
        ->check(CLI::Range(1, kMaxOrder));
    CLI::Option* rays =
        command->add_option("--rays", a.options.rays, "rays per receiver; directions where method is raster")
            ->capture_default_str()
            ->check(CLI::Range(1, kMostRays));
    command
        ->add_option(
            "--target-error", a.options.target_error,
            "relative L2 error of the direct light to reach, with as many rays as each receiver needs")
        ->check(above_zero())
        ->excludes(rays);
    add_transport(command, a.options);
    add_lamps(command, a.options.lamps);
    command
        ->add_option("--light-set", a.light_set,
                     "distant lights to keep one by one, by whose shadows suns shine later: a .json with the "
                     "sun's arc of a day, or a list")
        ->check(named)
        ->type_name("FILE");
    add_no_shadow(command, a.no_shadow);
    add_method(command, a.options);
    choice(command, "--storage", a.options.memory.storage, kStorages,
           "auto: float16 where its rounding is less than a tenth of the sampling error", "auto");
    command->add_option("--seed", a.options.seed, "seed of the samples")
        ->capture_default_str()
        ->check(seed());
    add_reading(command, a.reading);
    add_threads(command, a.options.threads);
    add_json(command, a.json);
}

} // namespace prt::cli

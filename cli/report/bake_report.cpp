// Reports a bake of vertices.

#include "cli/report/bake_report.h"

#include "cli/report/transfer_words.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/printable.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace prt::pipeline {
namespace {

void add_refinement_figures(const RefineStatistics& s, double target, Report& report) {
    const char* const ends[] = {"target", "vertices", "edges"};
    add_figures(report, {{"refine_target_relative_l2", target},
                         {"refine_end", ends[static_cast<std::size_t>(s.end)]},
                         {"refine_rounds", s.rounds},
                         {"vertices_before", s.before.vertices},
                         {"vertices_after", s.after.vertices},
                         {"triangles_before", s.before.triangles},
                         {"triangles_after", s.after.triangles},
                         {"refine_error_before_relative_l2", s.before.error},
                         {"refine_error_relative_l2", s.after.error},
                         {"refine_points", s.points},
                         {"refine_rays_per_point", s.rays_per_point},
                         {"refine_rays", s.rays},
                         {"refine_seconds", s.seconds}});
}

void add_refinement_sentences(const RefineStatistics& s, Report& report) {
    report.sentences.push_back(
        s.rounds == 0
            ? "refinement: no triangle was split; interpolation error of direct light "
              "{refine_error_relative_l2:.3f%}"
            : "refined in {refine_rounds:#round}, {refine_seconds:.3f} s: {vertices_before} to "
              "{vertices_after:#vertex|vertices}, {triangles_before} to {triangles_after:#triangle}; "
              "interpolation error of direct light {refine_error_before_relative_l2:.3f%} before, "
              "{refine_error_relative_l2:.3f%} after");
    if (s.end == RefineEnd::vertices)
        report.sentences.push_back("--refine: the target {refine_target_relative_l2:.3f%} was not reached "
                                   "within the vertex limit; raise it with --refine E,vertices=N");
    if (s.end == RefineEnd::edges)
        report.sentences.push_back("--refine: the target {refine_target_relative_l2:.3f%} was not reached; "
                                   "the remaining error is in triangles that are too small to split");
}

Json error_json(const BakeErrors::Error& error) {
    Json json = {
        {"relative_l2", nullptr}, {"standard_error", nullptr}, {"relative_to_scene", error.of_scene}};
    if (error.known) {
        json["relative_l2"] = error.relative_l2;
        json["standard_error"] = error.standard_error;
    }
    return json;
}

constexpr double kVisible = 0.02; ///< relative to the light of the scene

/// The error, where it is visible, and beyond doubt above `limit`; else 0.
double above(const BakeErrors::Error& error, double limit) {
    const bool is_above =
        error.of_scene > kVisible && (!error.known || error.relative_l2 - 2 * error.standard_error > limit);
    return !is_above ? 0 : error.known ? error.relative_l2 : std::numeric_limits<double>::infinity();
}

/// Returns the names of objects with `error(node)` above 0, worst first: "'Pole' 78 %, 'Hood' 31 %, 3 more";
/// empty if there is none.
template <class Error>
std::string worst_objects(const BakeErrors& errors, Error&& error) {
    constexpr std::size_t kNamed = 5;
    constexpr double kMaxShown = 10;
    std::vector<std::pair<double, std::string>> worst;
    for (const BakeErrors::Node& node : errors.nodes)
        if (const double here = error(node); here > 0)
            worst.emplace_back(here, node.name);
    std::ranges::stable_sort(worst, std::greater{}, &std::pair<double, std::string>::first);
    std::vector<std::string> words;
    for (const auto& [here, name] : worst)
        if (words.size() < kNamed)
            words.push_back(here > kMaxShown ? fmt::format("'{}' above 1000 %", printable(name))
                                             : fmt::format("'{}' {:.2g} %", printable(name), 100 * here));
    if (worst.size() > kNamed)
        words.push_back(fmt::format("{} more", worst.size() - kNamed));
    return fmt::format("{}", fmt::join(words, ", "));
}

Json errors_json(const BakeErrors& errors) {
    Json lamps = Json::array(), objects = Json::array();
    for (const BakeErrors::LampError& lamp : errors.each_lamp)
        lamps.push_back({{"name", lamp.name}, {"error", error_json(lamp.error)}});
    for (const BakeErrors::Node& node : errors.nodes)
        objects.push_back({{"name", node.name},
                           {"points", node.points},
                           {"sky", error_json(node.sky)},
                           {"lamps", error_json(node.lamps)},
                           {"back_sides", error_json(node.backs)},
                           {"back_sides_lamps", error_json(node.backs_by_lamps)}});
    constexpr double kBacksDiffer = 0.1;
    const std::string worse = worst_objects(errors, [&](const BakeErrors::Node& node) {
        return std::max(above(node.sky, 2 * errors.sky.relative_l2 + kVisible),
                        above(node.lamps, 2 * errors.lamps.relative_l2 + kVisible));
    });
    const std::string behind = worst_objects(errors, [](const BakeErrors::Node& node) {
        return std::max(above(node.backs, kBacksDiffer), above(node.backs_by_lamps, kBacksDiffer));
    });
    return {{"points", errors.points},
            {"sky", error_json(errors.sky)},
            {"direct", error_json(errors.direct)},
            {"indirect", error_json(errors.indirect)},
            {"lamps", error_json(errors.lamps)},
            {"back_sides", error_json(errors.backs)},
            {"back_sides_lamps", error_json(errors.backs_by_lamps)},
            {"each_lamp", lamps},
            {"objects", objects},
            {"worst_objects", worse},
            {"worst_back_sides", behind}};
}

void add_error_sentences(const Json& errors, Report& report) {
    const auto known = [&](const char* what) { return !errors[what]["relative_l2"].is_null(); };
    if (known("sky"))
        report.sentences.push_back(
            known("indirect") && errors["indirect"]["relative_l2"] > 0
                ? "error of sky light over the surface: {errors/sky/relative_l2:.2f%} (± "
                  "{errors/sky/standard_error:.2f%}); direct {errors/direct/relative_l2:.2f%}, indirect "
                  "{errors/indirect/relative_l2:.2f%}"
                : "error of sky light over the surface: {errors/sky/relative_l2:.2f%} (± "
                  "{errors/sky/standard_error:.2f%})");
    if (known("lamps"))
        report.sentences.emplace_back(
            "error of lamp light over the surface: {errors/lamps/relative_l2:.2f%} (± "
            "{errors/lamps/standard_error:.2f%})");
    if (errors["points"] == 0)
        report.sentences.emplace_back(
            "error over the surface: not measured, because every surface encloses a medium or is inside "
            "geometry");
    if (!errors["worst_objects"].get<std::string>().empty())
        report.sentences.emplace_back("objects with much larger errors: {errors/worst_objects}");
    if (!errors["worst_back_sides"].get<std::string>().empty())
        report.sentences.emplace_back(
            "the back sides of double-sided surfaces show the light of the front sides; errors there: "
            "{errors/worst_back_sides}; model walls with a thickness for separate light on both sides");
}

Json noise_json(const BakeNoise& noise) {
    return {{"filtered", noise.filtered},
            {"sky", noise.sky},
            {"direct", noise.direct},
            {"indirect", noise.indirect},
            {"lamps", noise.lamps}};
}

void add_noise_sentences(const BakeOutcome& baked, Report& report) {
    const BakeNoise& noise = baked.result.noise;
    if (baked.options.target_error)
        report.sentences.emplace_back("sampling error of direct light: target "
                                      "{target_error_relative_l2:.3f%}, estimate "
                                      "{sampling_error_relative_l2:.3f%}");
    else if (!baked.result.errors && !noise.filtered && baked.result.statistics.sampling_error > 0)
        report.sentences.emplace_back(
            "sampling error of direct light: estimate {sampling_error_relative_l2:.3f%}");
    if (noise.sky > 0)
        report.sentences.emplace_back("sampling noise of sky light: {noise/sky:.2f%}; direct "
                                      "{noise/direct:.2f%}, indirect {noise/indirect:.2f%}");
    if (!noise.lamps.empty())
        report.sentences.push_back(fmt::format(
            "sampling noise of bounced lamp light: at most {{noise/lamps/{}:.2f%}} of the light of one lamp",
            std::ranges::max_element(noise.lamps) - noise.lamps.begin()));
}

Json statistics_json(const BakeStatistics& s) {
    return {{"receivers", s.receivers.all},
            {"receivers_traced", s.receivers.traced},
            {"back_sides", s.receivers.back_sides},
            {"receivers_enclosed", s.receivers.sealed},
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
            {"gather_bytes_moved", s.gather.bytes_moved},
            {"notices", s.notices}};
}

constexpr double kDark = 0.05; ///< mean visibility; a cellar with a window has as much

/// Adds the statistics as sentences.
void add_sentences(const BakeOutcome& baked, const Json& statistics, Report& report) {
    const BakeResult& result = baked.result;
    const BakeStatistics& s = result.statistics;
    const bool raster = baked.options.tracer.method == BakeMethod::raster;
    const auto say = [&](std::string sentence) { report.sentences.push_back(std::move(sentence)); };
    say(fmt::format("{{output}}: {{receivers:#receiver}}, {{triangles:#triangle}}, order {{order}}, {}, "
                    "{{bake/rays_per_receiver:#{}}} per receiver, {{bake/bounces:#bounce}}",
                    terms_in_words(result.baked.transfer.layout), raster ? "direction" : "ray"));
    say(fmt::format("{} on the {}: {{device}}", raster ? "depth maps" : "ray tracing",
                    result.baked.record.backend == Backend::cpu ? "CPU" : "GPU"));
    if (s.receivers.all > s.receivers.traced)
        say(counted(s.receivers.all - s.receivers.traced, "receiver is", "receivers are") +
            " on no surface; the transfer there is zero");
    for (std::size_t i = 0; i < s.notices.size(); ++i)
        say(fmt::format("{{notices/{}}}", i));
    say(fmt::format("{{seconds:.3f}} s: build {{seconds_build:.3f}}, trace {{seconds_trace:.3f}}, accumulate "
                    "{{seconds_accumulate:.3f}}, GPU copies {{seconds_transfer:.3f}}, transport "
                    "{{seconds_transport:.3f}}; {{rays_per_second:.2fM}} million {}/s",
                    raster ? "tests" : "rays"));
    add_noise_sentences(baked, report);
    if (result.errors)
        add_error_sentences(statistics["errors"], report);
    if (baked.refinement)
        add_refinement_sentences(*baked.refinement, report);
    else if (s.fit.between > 0 || s.fit.samples > 0)
        say(fmt::format("interpolation error of direct light sampled at vertices: "
                        "{{interpolation_error_relative_l2:.3f%}}; {}",
                        s.fit.samples > 0
                            ? "vertices are fitted to {samples_per_receiver:#sample} of the surface each"
                            : "light is sampled at the vertices"));
    if (s.gather.entries > 0)
        say("bounce matrix: {gather_entries:#link} between receivers, {gather_bytes:.1fM} MB; "
            "omitted bounces: at most {remaining_energy:.2g%} of the largest transfer");
    if (s.gather.bytes_moved > 0)
        say("the GPU computed the bounces; {gather_bytes_moved:.1fM} MB were copied to it and back");
    if (s.lamps.count > 0)
        say("{lamps:#lamp}: {lamp_lights:#light} and {lamp_triangles:#emissive triangle}");
    say("mean visibility of the sky: {mean_visibility:.1f%} (uniform sky, without bounces)");
    if (s.mean_visibility < kDark && !baked.no_shadow && s.lamps.count == 0)
        say("almost no light enters the scene; if a sky dome or an outline shell blocks it, use --no-shadow "
            "MATERIAL");
}

} // namespace

void add_refinement(const RefineStatistics& refinement, double target, Report& report) {
    add_refinement_figures(refinement, target, report);
    add_refinement_sentences(refinement, report);
}

Report bake_report(const BakeOutcome& baked) {
    const BakeResult& result = baked.result;
    Report report;
    add_figures(report, {{"output", baked.output},
                         {"order", baked.options.order},
                         {"channels", result.baked.transfer.layout.channels()},
                         {"terms", terms_figures(result.baked.transfer.layout)},
                         {"storage", to_string(result.baked.storage)},
                         {"bake", bake_record_json(result.baked.record)}});
    if (baked.options.target_error)
        add_figures(report, {{"target_error_relative_l2", *baked.options.target_error}});
    Json statistics = statistics_json(result.statistics);
    statistics["triangles"] = baked.scene.triangles();
    for (const std::string& notice : baked.scene.notices)
        statistics["notices"].push_back(notice);
    statistics["noise"] = noise_json(result.noise);
    if (result.errors)
        statistics["errors"] = errors_json(*result.errors);
    add_figures(report, statistics);
    add_figures(report, {{"bytes_file", baked.bytes}});
    if (baked.refinement)
        add_refinement_figures(*baked.refinement, baked.refine_target, report);
    add_sentences(baked, statistics, report);
    return report;
}

} // namespace prt::pipeline

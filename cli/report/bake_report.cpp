// Reports a bake of vertices.

#include "report/bake_report.h"

#include "options.h"
#include "prt/support/printable.h"
#include "report/publish.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace prt::cli {
namespace {

Json refinement_json(const RefineStatistics& s, double target) {
    const char* const ends[] = {"target", "vertices", "edges"};
    return {{"refine_target_relative_l2", target},
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
            {"refine_seconds", s.seconds}};
}

void add_refinement_sentences(const RefineStatistics& s, Report& report) {
    report.sentences.push_back(
        s.rounds == 0
            ? "refined: no triangle is split; between vertices direct light errs by "
              "{refine_error_relative_l2:.3f%}"
            : "refined in {refine_rounds} rounds, {refine_seconds:.3f} s: from {vertices_before} vertices to "
              "{vertices_after}, from {triangles_before} triangles to {triangles_after}; between vertices "
              "direct light errs by {refine_error_relative_l2:.3f%}, before by "
              "{refine_error_before_relative_l2:.3f%}");
    if (s.end == RefineEnd::vertices)
        report.sentences.push_back("--refine asked for {refine_target_relative_l2:.3f%}, for which "
                                   "--most-vertices is too few");
    if (s.end == RefineEnd::edges)
        report.sentences.push_back("--refine asked for {refine_target_relative_l2:.3f%}: what is left is in "
                                   "triangles too small to split");
}

Json error_json(const BakeErrors::Error& error) {
    Json json = {{"relative_l2", nullptr}, {"standard_error", nullptr}, {"of_scene", error.of_scene}};
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
            words.push_back(here > kMaxShown ? fmt::format("'{}' over 1000 %", printable(name))
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
                           {"backs", error_json(node.backs)},
                           {"backs_by_lamps", error_json(node.backs_by_lamps)}});
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
            {"backs", error_json(errors.backs)},
            {"backs_by_lamps", error_json(errors.backs_by_lamps)},
            {"each_lamp", lamps},
            {"objects", objects},
            {"much_worse", worse},
            {"much_worse_behind", behind}};
}

void add_error_sentences(const Json& errors, Report& report) {
    const auto known = [&](const char* what) { return !errors[what]["relative_l2"].is_null(); };
    if (known("sky"))
        report.sentences.push_back(
            known("indirect") && errors["indirect"]["relative_l2"] > 0
                ? "error over the surface: {errors/sky/relative_l2:.2f%} of the sky's light (± "
                  "{errors/sky/standard_error:.2f%}); direct {errors/direct/relative_l2:.2f%}, bounced "
                  "{errors/indirect/relative_l2:.2f%}"
                : "error over the surface: {errors/sky/relative_l2:.2f%} of the sky's light (± "
                  "{errors/sky/standard_error:.2f%})");
    if (known("lamps"))
        report.sentences.emplace_back(
            "error over the surface: {errors/lamps/relative_l2:.2f%} of the light of "
            "lamps (± {errors/lamps/standard_error:.2f%})");
    if (errors["points"] == 0)
        report.sentences.emplace_back(
            "error over the surface: not measured, all of it is over media or sealed in");
    if (!errors["much_worse"].get<std::string>().empty())
        report.sentences.emplace_back("objects with much larger errors: {errors/much_worse}");
    if (!errors["much_worse_behind"].get<std::string>().empty())
        report.sentences.emplace_back(
            "seen from behind, two-sided surfaces show the light of their fronts, which errs there: "
            "{errors/much_worse_behind}; each side of a wall with a thickness has its own");
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
        report.sentences.emplace_back("error of rays: {target_error_relative_l2:.3f%} of the direct light "
                                      "asked for, {sampling_error_relative_l2:.3f%} estimated");
    else if (!baked.result.errors && !noise.filtered && baked.result.statistics.sampling_error > 0)
        report.sentences.emplace_back(
            "error of the direct light: {sampling_error_relative_l2:.3f%} estimated");
    if (noise.sky > 0)
        report.sentences.emplace_back("noise of rays: {noise/sky:.2f%} of the sky's light; direct "
                                      "{noise/direct:.2f%}, bounced {noise/indirect:.2f%}");
    if (!noise.lamps.empty())
        report.sentences.push_back(fmt::format(
            "noise of rays in bounces of lamps: at most {{noise/lamps/{}:.2f%}} of the light of one",
            std::ranges::max_element(noise.lamps) - noise.lamps.begin()));
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
    say(fmt::format("{{output}}: {{receivers}} receivers, {{triangles}} triangles, order {{order}}, "
                    "{}, {{bake/rays_per_receiver}} {} each, {{bake/bounces}} bounces",
                    terms_in_words(result.baked.transfer.layout), raster ? "directions" : "rays"));
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
    add_noise_sentences(baked, report);
    if (result.errors)
        add_error_sentences(statistics["errors"], report);
    if (baked.refinement)
        add_refinement_sentences(*baked.refinement, report);
    else if (s.fit.between > 0 || s.fit.samples > 0)
        say(fmt::format(
            "between vertices direct light would err by {{interpolation_error_relative_l2:.3f%}}: {}",
            s.fit.samples > 0 ? "vertices are fitted to {samples_per_receiver} samples of the surface each"
                              : "it is measured at vertices"));
    if (s.gather.entries > 0)
        say("bounces: {gather_entries} pairs of receivers that light each other, {gather_bytes:.1fM} MB; at "
            "most {remaining_energy:.2g%} of a receiver's light is missing");
    if (s.gather.bytes_moved > 0)
        say("the GPU applied them: {gather_bytes_moved:.1fM} MB went to it and came back");
    if (s.lamps.count > 0)
        say("lamps: {lamps}, of {lamp_lights} lights and {lamp_triangles} triangles that shine");
    say("{mean_visibility:.1f%} of the light of a uniform sky arrives, on average");
    if (s.mean_visibility < kDark && !baked.no_shadow && s.lamps.count == 0)
        say("hardly any light comes in: where a shell round the scene, as an outline or a sky, keeps it out, "
            "--no-shadow MATERIAL lets it pass");
}

} // namespace

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
        add_figures(report, refinement_json(*baked.refinement, baked.refine_target));
    add_sentences(baked, statistics, report);
    return report;
}

} // namespace prt::cli

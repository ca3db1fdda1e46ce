// Reports a bake whose instances share transfer.

#include "report/instance_report.h"

#include "report/publish.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace prt::cli {

Json percentiles(std::vector<double> errors) {
    std::ranges::sort(errors);
    const auto at = [&](double share) {
        return errors[static_cast<std::size_t>(std::lround(share * static_cast<double>(errors.size() - 1)))];
    };
    return {{"median", at(0.5)}, {"percentile_90", at(0.9)}, {"percentile_99", at(0.99)}, {"most", at(1)}};
}

Report instance_report(const InstanceOutcome& outcome) {
    const InstancedBake& baked = outcome.baked;
    const InstanceStatistics& s = baked.bake.statistics;
    const BakedTransfer& transfer = baked.bake.baked;
    Report report;
    add_figures(report, {{"output", outcome.output},
                         {"order", transfer.transfer.layout.order},
                         {"channels", transfer.transfer.layout.channels()},
                         {"terms", terms_figures(transfer.transfer.layout)},
                         {"storage", to_string(transfer.storage)},
                         {"bake", bake_record_json(transfer.record)},
                         {"triangles", outcome.scene.triangles()},
                         {"receivers", outcome.scene.receivers()},
                         {"receivers_stored", transfer.transfer.receivers()},
                         {"receivers_traced", s.receivers},
                         {"samples_traced", s.samples},
                         {"rays", baked.rays},
                         {"seconds", baked.seconds},
                         {"bytes_file", outcome.bytes},
                         {"notices", s.notices},
                         {"instances",
                          {{"meshes", baked.meshes.meshes.size()},
                           {"shared", baked.bake.instances.factors.size()},
                           {"baked_alone", baked.baked_alone},
                           {"mirrored", baked.meshes.mirrored},
                           {"uneven", baked.meshes.uneven},
                           {"bent", baked.meshes.bent},
                           {"in_the_open", s.alone},
                           {"error_allowed_relative_l2", outcome.error},
                           {"lights", s.lights},
                           {"error_relative_l2", percentiles(baked.bake.errors)},
                           {"error_before_relative_l2", percentiles(baked.first_errors)},
                           {"errors_before_relative_l2", baked.first_errors},
                           {"errors_relative_l2", baked.bake.errors}}}});
    report.sentences = {
        fmt::format("{{output}}: {{receivers}} vertices of {{triangles}} triangles by transfer of "
                    "{{receivers_stored}}, order {{order}}, {}, {{bake/rays_per_receiver}} rays each, "
                    "{{bake/bounces}} bounces",
                    terms_in_words(transfer.transfer.layout)),
        "{instances/shared} instances share that of {instances/meshes} meshes; {instances/baked_alone} would "
        "err by "
        "more than {instances/error_allowed_relative_l2:.1f%} and are baked alone",
        "their light errs by {instances/error_relative_l2/median:.2f%} in the middle, "
        "{instances/error_relative_l2/percentile_99:.2f%} at the 99th of a hundred, "
        "{instances/error_relative_l2/most:.2f%} at most (soft skies and {instances/lights} given ones, at "
        "the samples)"};
    for (std::size_t i = 0; i < s.notices.size(); ++i)
        report.sentences.push_back(fmt::format("{{notices/{}}}", i));
    report.sentences.emplace_back(
        "{seconds:.3f} s: {receivers_traced} vertices and {samples_traced} samples of "
        "instances, {rays} rays");
    return report;
}

void add_instance_constants(const std::vector<RelitInstance>& instances, Json figures, Report& report) {
    std::size_t rows = 0;
    for (const RelitInstance& instance : instances)
        rows += instance.rows.count;
    const std::size_t bytes = 3 * sizeof(glm::vec4) * rows;
    figures["bytes_constants"] = bytes;
    figures["bytes_constants_per_instance"] = bytes / instances.size();
    add_figures(report, {{"instances", std::move(figures)}});
    report.sentences.emplace_back(
        "GPU: {instances/bytes_constants_per_instance} bytes of constants of an instance per lighting, "
        "{instances/bytes_constants} of all; fewer clusters take less (prt compress --clusters)");
}

} // namespace prt::cli

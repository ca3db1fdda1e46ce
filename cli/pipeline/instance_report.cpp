// Reports a bake whose instances share transfer.

#include "cli/pipeline/instance_report.h"

#include "cli/report/bake_report.h"
#include "cli/report/transfer_words.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace prt::pipeline {

Json percentiles(std::vector<double> errors) {
    std::ranges::sort(errors);
    const auto at = [&](double share) {
        return errors[static_cast<std::size_t>(std::lround(share * static_cast<double>(errors.size() - 1)))];
    };
    return {{"median", at(0.5)}, {"percentile_90", at(0.9)}, {"percentile_99", at(0.99)}, {"max", at(1)}};
}

namespace {

Json instance_figures(const InstanceOutcome& outcome) {
    const InstancedBake& baked = outcome.baked;
    const InstanceStatistics& s = baked.bake.statistics;
    Json figures = {{"meshes", baked.meshes.meshes.size()},
                    {"shared", baked.bake.instances.factors.size()},
                    {"baked_separately", baked.baked_alone},
                    {"mirrored", baked.meshes.mirrored},
                    {"nonuniform_scale", baked.meshes.uneven},
                    {"deformed", baked.meshes.bent},
                    {"unoccluded", s.alone},
                    {"error_allowed_relative_l2", outcome.error},
                    {"lights", s.lights},
                    {"error_relative_l2", percentiles(baked.bake.errors)},
                    {"error_before_relative_l2", percentiles(baked.first_errors)},
                    {"errors_before_relative_l2", baked.first_errors},
                    {"errors_relative_l2", baked.bake.errors}};
    if (!baked.bake.lamp_errors.empty())
        figures["lamp_error_relative_l2"] = percentiles(baked.bake.lamp_errors);
    return figures;
}

} // namespace

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
                         {"instances", instance_figures(outcome)}});
    report.sentences = {
        fmt::format(
            "{{output}}: {{receivers:#vertex|vertices}}, {{triangles:#triangle}}, transfer stored for "
            "{{receivers_stored:#vertex|vertices}}, order {{order}}, {}, {{bake/rays_per_receiver:#ray}} "
            "per vertex, {{bake/bounces:#bounce}}",
            terms_in_words(transfer.transfer.layout)),
        "shared transfer: {instances/meshes:#mesh|meshes}, {instances/shared:#instance}; baked separately "
        "because of an error above {instances/error_allowed_relative_l2:.1f%}: "
        "{instances/baked_separately:#instance}",
        "error of shared transfer: median {instances/error_relative_l2/median:.2f%}, 99th percentile "
        "{instances/error_relative_l2/percentile_99:.2f%}, maximum {instances/error_relative_l2/max:.2f%} "
        "(at the samples, under soft skies and {instances/lights:#given light})"};
    if (!baked.bake.lamp_errors.empty())
        report.sentences.emplace_back(
            "error of the light of lamps: median {instances/lamp_error_relative_l2/median:.2f%}, 99th "
            "percentile "
            "{instances/lamp_error_relative_l2/percentile_99:.2f%}, maximum "
            "{instances/lamp_error_relative_l2/max:.2f%} (at the vertices, all lamps together)");
    if (outcome.refinement)
        add_refinement(*outcome.refinement, outcome.refine_target, report);
    for (std::size_t i = 0; i < s.notices.size(); ++i)
        report.sentences.push_back(fmt::format("{{notices/{}}}", i));
    report.sentences.emplace_back(
        "{seconds:.3f} s: {receivers_traced:#vertex|vertices} and {samples_traced:#sample} of instances, "
        "{rays:#ray}");
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
        "GPU memory for each lighting: {instances/bytes_constants_per_instance} bytes of constants per "
        "instance, {instances/bytes_constants} in total; fewer clusters (prt compress --clusters) need less");
}

} // namespace prt::pipeline

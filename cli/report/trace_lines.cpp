// Writes the events of the compressor as JSON lines, for `prt compress --trace`.
#include "cli/report/trace_lines.h"

namespace prt::pipeline {
namespace {

Json as_json(const ClustersSeeded& e) {
    return {{"event", "seeded"}, {"clusters", e.clusters}, {"axes", e.axes}};
}

Json as_json(const ClusteringRound& e) {
    return {{"event", "clustering_round"}, {"component_limit", e.component_limit}, {"cost", e.cost}};
}

Json as_json(const ClusterSplit& e) {
    return {{"event", "split"}, {"cluster", e.cluster}, {"into", e.into}, {"gain", e.gain}};
}

Json as_json(const ClusterMerge& e) {
    return {{"event", "merge"}, {"cluster", e.cluster}, {"into", e.into}, {"loss", e.loss}};
}

Json as_json(const MovesTried& e) {
    return {
        {"event", "moves"}, {"cost_before", e.cost_before}, {"cost_after", e.cost_after}, {"kept", e.kept}};
}

Json as_json(const CodingRound& e) {
    return {{"event", "coding_round"}, {"rounded", e.rounded}, {"error", e.error}};
}

Json as_json(const SearchTrial& e) {
    Json json = {{"event", "trial"}};
    json.update(trial_json(e));
    return json;
}

} // namespace

std::string trace_line(const CompressEvent& event) {
    return std::visit([](const auto& e) { return as_json(e); }, event).dump() + "\n";
}

Json trial_json(const SearchTrial& trial) {
    return {{"clusters", trial.clusters},
            {"bytes_bound_per_vertex", trial.payload_bytes},
            {"lit_rms", trial.lit_rms},
            {"worst_lit_rms", trial.worst_lit_rms},
            {"sky_contrast", trial.sky_contrast},
            {"lamp_contrast", trial.lamp_contrast},
            {"jump", trial.jump},
            {"bytes_bound_per_vertex_with_bases", trial.bytes_per_vertex},
            {"shader_operations", trial.operations}};
}

} // namespace prt::pipeline

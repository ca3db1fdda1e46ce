// Writes what the compressor tells of its work, for `prt compress --trace`.
#include "report/trace_lines.h"

#include "report/report.h"

namespace prt::cli {
namespace {

Json as_json(const ClustersSeeded& e) {
    return {{"event", "seeded"}, {"clusters", e.clusters}, {"axes", e.axes}};
}

Json as_json(const ClusteringRound& e) {
    return {{"event", "clustering_round"}, {"most_components", e.most_components}, {"cost", e.cost}};
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
    return {{"event", "trial"},
            {"clusters", e.clusters},
            {"bytes_bound_per_vertex", e.payload_bytes},
            {"lit_rms", e.lit_rms},
            {"worst_lit_rms", e.worst_lit_rms},
            {"jump", e.jump},
            {"bytes_bound_per_vertex_with_bases", e.bytes_per_vertex},
            {"shader_operations", e.operations}};
}

} // namespace

std::string trace_line(const CompressEvent& event) {
    return std::visit([](const auto& e) { return as_json(e); }, event).dump() + "\n";
}

} // namespace prt::cli

#include "report/far_report.h"

namespace prt::cli {

void add_far_blockers(const std::optional<FarBlockerFigures>& figures, Report& report) {
    if (!figures)
        return;
    const FarBlockerFigures& f = *figures;
    add_figures(report, {{"far_blockers",
                          {{"distance_metres", f.distance},
                           {"voxel_metres", f.voxel_size},
                           {"nodes", f.nodes},
                           {"triangles", f.triangles},
                           {"voxels", f.voxels},
                           {"bytes", f.bytes},
                           {"seconds", f.seconds},
                           {"error_relative_l2", f.error}}}});
    if (f.voxels == 0)
        report.sentences.emplace_back("far blockers: no node has 64 triangles or more within "
                                      "{far_blockers/distance_metres:g} m, so that "
                                      "voxels stand in for nothing");
    else
        report.sentences.emplace_back(
            "from {far_blockers/distance_metres:g} m on {far_blockers/voxels} voxels of "
            "{far_blockers/voxel_metres:.3g} m, made in {far_blockers/seconds:.3f} s, stand in for "
            "{far_blockers/triangles} triangles of {far_blockers/nodes} nodes; direct light errs by "
            "{far_blockers/error_relative_l2:.3f%} by them");
}

} // namespace prt::cli

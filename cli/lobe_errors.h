#pragma once

// What lobes err by in frames of an animation, beside what other transfer of one vertex does that turns with
// its skin.

#include "prt/lobes.h"
#include "prt/pose_bake.h"
#include "report/report.h"

#include <span>

namespace prt::cli {

struct LobeErrorRequest {
    const AnimatedScene& model;
    const LobeModel& lobes;   ///< as shipped
    const MeanTransfer& mean; ///< that they were fitted to
    std::span<const ModelPose> frames;
    PoseBakeOptions options; ///< of the bakes that frames are compared with; another seed than the fit's
};

/// Adds tables `lobe_errors` and `lobe_errors_by_frame` to `report`, their root mean squares as figures and
/// sentences. Vertices that a frame seals in count nothing.
void add_lobe_errors(const LobeErrorRequest& request, const Progress& progress, Report& report);

} // namespace prt::cli

#pragma once

// Measures errors of lobes in frames of an animation, and of other kinds of transfer that rotate with the
// skin.

#include "cli/report/report.h"
#include "prt/bake/pose_bake.h"
#include "prt/core/lobes.h"

#include <cstddef>
#include <span>
#include <vector>

namespace prt::pipeline {

struct LobeErrorRequest {
    const AnimatedScene& model;
    std::vector<std::size_t> figure; ///< receivers with lobes; others are ignored
    const LobeModel& lobes;          ///< the shipped lobes
    const MeanTransfer& mean;        ///< the lobes were fitted to it
    std::span<const ModelPose> frames;
    PoseBakeOptions options; ///< options of the reference bakes of the frames; their seed differs from that
                             ///< of the fit
};

/// Adds tables `lobe_errors` and `lobe_errors_by_frame` to `report`, and their root mean squares as figures
/// and sentences. Vertices inside geometry in a frame are ignored.
void add_lobe_errors(const LobeErrorRequest& request, const Progress& progress, Report& report);

} // namespace prt::pipeline

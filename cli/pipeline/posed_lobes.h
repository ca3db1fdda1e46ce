#pragma once

// Converts lobes to transfer in a pose, for code that does not support lobes.

#include "cli/pipeline/model.h"
#include "prt/bake/pose_bake.h"

namespace prt::pipeline {

/// Computes the transfer vector [order²] of the lobes of a vertex in the pose of `frames`.
void lobe_transfer_in_pose(const LobeModel& lobes, const VertexFrames& frames, std::size_t vertex, int order,
                           std::span<float> transfer);

/// Returns the transfer of the lobes of `model`, which must have lobes, in the pose of the file: `combined`,
/// with one channel and the order of the lobes.
BakedTransfer lobes_as_transfer(const SceneFile& model);

} // namespace prt::pipeline

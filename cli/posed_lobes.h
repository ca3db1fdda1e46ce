#pragma once

// Lobes as transfer of a pose, for what knows no lobes.

#include "inputs.h"
#include "prt/pose_bake.h"

namespace prt::cli {

/// The transfer vector [order²] that the lobes of a vertex are together in the pose of `frames`.
void lobe_transfer_in_pose(const LobeModel& lobes, const VertexFrames& frames, std::size_t vertex, int order,
                           std::span<float> transfer);

/// The transfer that the lobes of `model`, which has some, are together in the pose of the file: `whole`, of
/// one channel and as many bands as they have.
BakedTransfer lobes_as_transfer(const SceneFile& model);

} // namespace prt::cli

#pragma once

// Lobes of vertices in a pose.

#include "cli/pipeline/model.h"
#include "prt/bake/pose_bake.h"
#include "prt/core/light.h"

#include <array>
#include <span>

namespace prt::pipeline {

/// Returns the lobes of a vertex in the pose of `frames`.
std::array<Lobe, kMaxLobes> lobes_in_pose(const LobeModel& lobes, const VertexFrames& frames,
                                          std::size_t vertex);

/// Replaces the exit radiance for albedo 1 of vertices with lobes, in the pose of the file, under all light
/// of `lighting`. `radiance`: [receivers of the scene]. Does nothing without lobes.
void light_lobes(const SceneFile& model, const Lighting& lighting, std::span<glm::vec3> radiance);

} // namespace prt::pipeline

#pragma once

// Share of the light of receivers near an object that the object blocks, by rays.

#include "prt/bake/ambient_occlusion.h"

#include <glm/vec3.hpp>

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// A position is inside the object if more of its rays end at backs.
inline constexpr float kMaxOccluderBackShare = 0.25f;

/// Options of the bake of order 2 that measures the blocked share and its direction.
BakeOptions bake_options(const OccluderOptions& options);

/// Returns the blocked share of the light of receivers from a uniform environment, with the cosine law;
/// nothing for receivers inside `scene`.
std::vector<std::optional<float>> blocked_by_rays(const Scene& scene, std::span<const glm::vec3> positions,
                                                  std::span<const glm::vec3> normals,
                                                  const BakeOptions& options, const Progress& progress);

} // namespace prt

#pragma once

// How much an object blocks of the light of receivers in the open near it, by rays.

#include "prt/occluder_bake.h"

#include <glm/vec3.hpp>

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// A place is inside of the object where more of its rays end at backs.
inline constexpr float kMostOccluderBacks = 0.25f;

/// The bake of order 2 that sees how much is blocked, and where.
BakeOptions bake_options(const OccluderOptions& options);

/// Of the light of receivers, by the cosine law, from everywhere alike; nothing for those inside of `scene`.
std::vector<std::optional<float>> blocked_by_rays(const Scene& scene, std::span<const glm::vec3> places,
                                                  std::span<const glm::vec3> normals,
                                                  const BakeOptions& options, const Progress& progress);

} // namespace prt

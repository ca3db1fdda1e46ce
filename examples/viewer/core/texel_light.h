#pragma once

// Computes the light of a few texels of a lightmap on the CPU.

#include "pictures/model.h"

#include "prt/core/transfer.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace viewer {

/// Returns the exit radiance for albedo 1 of some texels of a lightmap, in ascending order. Uses the
/// compressed transfer if it exists, otherwise the raw one; texels without a baked receiver are black.
std::vector<glm::vec3> texel_radiance(const LoadedModel& loaded, const prt::Lighting& lighting,
                                      std::span<const std::uint32_t> texels);

/// Returns the index of `texel` in `texels`, which is in ascending order; empty if it is not there.
std::optional<std::size_t> receiver_of(std::span<const std::uint32_t> texels, std::uint32_t texel);

} // namespace viewer

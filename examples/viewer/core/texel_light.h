#pragma once

// Light of a few places of a lightmap, on the CPU.

#include "pictures/model.h"

#include "prt/transfer.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace viewer {

/// Exit radiance for albedo 1 of some texels of a lightmap, in ascending order: of the compressed transfer
/// where there is some, else of the raw one; black where a bake has none.
std::vector<glm::vec3> texel_radiance(const LoadedModel& loaded, const prt::Lighting& lighting,
                                      std::span<const std::uint32_t> texels);

/// Which of the receivers `texels`, in ascending order, `texel` is; nothing: none.
std::optional<std::size_t> receiver_of(std::span<const std::uint32_t> texels, std::uint32_t texel);

} // namespace viewer

#pragma once

// Light of a few places of a lightmap, on the CPU.

#include "pictures/model.h"

#include "prt/transfer.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace viewer {

/// Exit radiance for albedo 1 at some vertices of a model whose transfer is of texels, as a filter reads it
/// there: of the compressed transfer where there is some, else of the raw one.
std::vector<glm::vec3> texel_radiance_at(const LoadedModel& loaded, const prt::Lighting& lighting,
                                         std::span<const std::uint32_t> vertices);

/// Which of the receivers `texels`, in ascending order, `texel` is; nothing: none.
std::optional<std::size_t> receiver_of(std::span<const std::uint32_t> texels, std::uint32_t texel);

} // namespace viewer

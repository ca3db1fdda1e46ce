#pragma once

// Background jobs that compute transfer.

#include "core/findings.h"
#include "pictures/lamps.h"

namespace viewer {

inline constexpr int kBakeOrder = 6, kBakeBounces = 3;

/// Reads the first of `paths`. Takes over transfer from the others, and from `open` (which may be empty), if
/// they hold the same scene: raw and compressed transfer of the same receivers, and vertices together with a
/// lightmap. Throws `prt::Error` if another path holds another scene or adds nothing.
OpenModels load_together(const std::vector<std::filesystem::path>& paths, const OpenModels& open);

/// Bakes with few rays first and then with more, and posts each result. Returns the last.
Baked bake_in_stages(Channel& channel, const Model& model);

/// Compresses a model with raw transfer.
Compressed compress_as(Channel& channel, const LoadedModel& loaded, const CompressionSettings& how);

/// Writes the model's file with its compressed transfer, for use in games. Throws `prt::Error` if it cannot
/// be written, or if the file now holds another scene.
void save_compressed(const LoadedModel& loaded, const std::filesystem::path& output);

/// Returns the colors of all available number pictures. The model must have compressed transfer. [receivers],
/// or [texels of all maps] for a lightmap.
std::vector<std::pair<PictureKind, std::vector<glm::vec3>>>
number_pictures(const LoadedModel& loaded, const prt::Lighting& lighting, const LampSettings& lamps);

} // namespace viewer

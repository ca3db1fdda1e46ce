#pragma once

// What the viewer computes of transfer in the background.

#include "core/findings.h"
#include "pictures/lamps.h"

namespace viewer {

inline constexpr int kBakeOrder = 6, kBakeBounces = 3;

/// Reads the first of `paths` and takes over transfer from the others, and from `open`, which may be empty,
/// where they hold the same scene: raw and compressed transfer of the same receivers, and vertices and a
/// lightmap beside each other. Throws `prt::Error` where another path is of another scene or adds nothing.
OpenModels load_together(const std::vector<std::filesystem::path>& paths, const OpenModels& open);

/// Bakes with few rays first and then with more, and posts each result. Returns the last.
Baked bake_in_stages(Channel& channel, const Model& model);

/// Of one with raw transfer.
Compressed compress_as(Channel& channel, const LoadedModel& loaded, const CompressionSettings& how);

/// Writes the model's file with its compressed transfer in it, for games. Throws `prt::Error` where it
/// cannot, or where the file has become another scene.
void save_compressed(const LoadedModel& loaded, const std::filesystem::path& output);

/// Colors of all pictures of numbers that there are, of one with compressed transfer: [receivers], or
/// [texels of all maps] of a lightmap.
std::vector<std::pair<PictureKind, std::vector<glm::vec3>>>
number_pictures(const LoadedModel& loaded, const prt::Lighting& lighting, const LampSettings& lamps);

} // namespace viewer

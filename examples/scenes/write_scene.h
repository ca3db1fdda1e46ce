#pragma once

#include "example_scenes.h"

#include <filesystem>

namespace examples {

/// Writes a scene as .glb, one mesh with a primitive and a material per part, and a node per
/// lamp. Throws std::runtime_error.
void write_scene(const ExampleScene& scene, const std::filesystem::path& path);

} // namespace examples

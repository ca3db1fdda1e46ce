#pragma once

// Seed corpora: small files that are right, of every kind that the targets read. Each function fills folders.

#include <filesystem>

namespace prt::fuzz {

using Path = std::filesystem::path;

/// `models`: scenes as .glb and .gltf, bakes, shipped files of every weight format, and lightmaps.
void write_model_seeds(const Path& folder);

/// `exr`, `hdr`, `pictures`: lat-long maps of every kind.
void write_environment_seeds(const Path& folder);

/// `mesh`, `meshopt`, `light`, `round_trip`, `words`: inputs of the other targets.
void write_other_seeds(const Path& folder);

} // namespace prt::fuzz

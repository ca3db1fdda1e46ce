#pragma once

// OBJ and PLY meshes as glTF documents.

#include "prt/gltf.h"

namespace prt::cli {

/// Reads a glTF, OBJ or PLY file; the suffix decides. OBJ and PLY become glTF: polygons are triangulated,
/// equal vertices welded, points and lines left out; diffuse color (`Kd`, `map_Kd`) is the base color, `Ke`
/// the emission, `d` the opacity; colors of vertices are sRGB, as scanners write them, and become linear.
/// Files that an OBJ names must lie in its folder unless `options.allow_outside`. Throws `Error` with the
/// file.
GltfDocument load_model(const std::filesystem::path& path, const GltfOptions& options = {});

} // namespace prt::cli

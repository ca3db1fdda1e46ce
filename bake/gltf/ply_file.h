#pragma once

#include "bake/gltf/mesh_file.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Reads a PLY file (G. Turk, "The PLY Polygon File Format", 1994): ASCII or binary of both byte orders,
/// vertices x, y, z with normals (nx, ny, nz), colors (red, green, blue, sRGB) and texture coordinates (s, t;
/// u, v; texture_u, texture_v), and faces with lists `vertex_indices` or `vertex_index`. Polygons are cut
/// into fans. Other elements and properties are ignored. Throws `Error`.
MeshArrays read_ply(std::span<const std::byte> file);

} // namespace prt

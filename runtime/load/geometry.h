#pragma once

// Extraction of vertices and triangles from a glTF file.

#include "prt/load/scene.h"
#include "runtime/load/gltf_data.h"
#include "runtime/load/level_nodes.h"
#include "runtime/load/unit_range.h"

#include <cstddef>
#include <map>
#include <vector>

namespace prt {

/// Data to keep: the movement of vertices requires the memory of the scene again.
enum class Keep { scene, moving };

struct Geometry {
    /// Without lights, images and textures of materials. Notices are about the geometry only.
    Scene scene;
    /// [vertex arrays], for vertices of the file; VertexArray::source maps vertices that flat normals split.
    /// Normals are empty if the file has none.
    std::vector<MovingVertices> moving;
    std::map<int, Skin> skins;         ///< skins that vertices use
    std::size_t finest_primitives = 0; ///< number of primitives before those of coarser levels
    LevelNodes nodes;
};

/// Extracts the scene without coarser levels. Values that glTF requires in 0..1 are clamped by `range`.
/// Throws `Error` as `extract_scene`.
Geometry extract_geometry(const GltfData& data, UnitRange& range, Keep keep = Keep::scene);
/// Extracts the scene, followed by the coarser levels of its nodes.
Geometry extract_geometry_with_levels(const GltfData& data, UnitRange& range, Keep keep = Keep::scene);

} // namespace prt

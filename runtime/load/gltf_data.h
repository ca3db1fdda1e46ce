#pragma once

// A glTF file in memory, as far as reading of geometry and transfer needs it.

#include "runtime/load/gltf_model.h"
#include "runtime/load/json.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// A node whose instances became nodes `first` and following, and its EXT_mesh_gpu_instancing extension.
struct ExpandedNode {
    std::size_t node, first, count;
    Json extension;
};

/// A mesh that node `stand_in` draws in its own frame while the document is in memory; in the file, `drawers`
/// draw it.
struct DeduplicatedMesh {
    std::size_t stand_in;
    std::vector<std::size_t> drawers;
};

struct GltfData {
    std::filesystem::path path;
    Json json;
    GltfModel model;
    std::vector<std::string> notices; ///< changes made while reading, one line each
    std::size_t file_bytes = 0;       ///< size of the file and its external buffers
    double scene_limit = 0;           ///< GltfOptions::scene_limit
    bool leave_out_lobes = false;     ///< GltfOptions::leave_out_lobes
    std::string limit_remedy;         ///< end of the message about a scene that needs too much memory
    std::vector<ExpandedNode> expanded;
    std::vector<DeduplicatedMesh> separate;
};

} // namespace prt

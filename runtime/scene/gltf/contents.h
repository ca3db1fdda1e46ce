#pragma once

// Contents of a GltfDocument. Reading uses tinygltf's model; writing edits the JSON, because tinygltf's
// writer drops unknown data.

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include <cstddef>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace prt {

using Json = nlohmann::ordered_json;

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

struct GltfContents {
    std::filesystem::path path;
    /// Model from the file; edits of `json` do not update it, but its views follow the bytes.
    tinygltf::Model model;
    Json json;
    std::vector<std::vector<std::byte>> images; ///< encoded, by image index; empty: cannot be read
    std::vector<std::string> image_troubles;    ///< why images cannot be read, by image index
    std::vector<std::string> notices;           ///< changes made while reading, one line each
    std::size_t file_bytes = 0;                 ///< size of the file and its external buffers
    double scene_limit = 0;                     ///< GltfOptions::scene_limit
    std::vector<ExpandedNode> expanded;
    std::vector<DeduplicatedMesh> separate;

    /// The single buffer for all views of `json` and of `model`.
    std::vector<unsigned char>& binary() { return model.buffers.front().data; }
    std::span<const std::byte> binary() const { return std::as_bytes(std::span(model.buffers.front().data)); }

    /// Appends bytes, aligned to 4, and a buffer view for them. `stride` 0: no stride. Returns the index of
    /// the view.
    std::size_t add_buffer_view(std::span<const std::byte> bytes, std::size_t stride = 0,
                                bool vertices = false);
    /// Appends an accessor and returns its index.
    std::size_t add_accessor(Json accessor);
    /// Adds `name` to extensionsUsed.
    void use_extension(const std::string& name);
    /// Removes `name` from extensionsUsed and extensionsRequired.
    void drop_extension(const std::string& name);
    /// Removes bytes from the buffer that no view references.
    void cut_unused_bytes();
    /// Removes the surface extensions of prtkit, with their attributes, accessors and data.
    void remove_transfer();
    /// Removes the volume of prtkit with its data.
    void remove_volume();
    /// Removes unreferenced elements of `accessors` and `views`, with their data.
    void remove_unused(std::set<std::size_t> accessors, std::set<std::size_t> views = {});
};

inline constexpr const char* kTransferExtension = "PRTKIT_transfer";
inline constexpr const char* kClusteredExtension = "PRTKIT_clustered_pca";
inline constexpr const char* kLightmapExtension = "PRTKIT_lightmap";
inline constexpr const char* kLobeExtension = "PRTKIT_lobes";
inline constexpr const char* kVolumeExtension = "PRTKIT_transfer_volume";
inline constexpr const char* kInstancesExtension = "PRTKIT_instances"; ///< at nodes, and at the top level
inline constexpr int kInstancesVersion = 2;
inline constexpr const char* kInstancingExtension = "EXT_mesh_gpu_instancing";
inline constexpr const char* kOccluderExtension = "PRTKIT_occlusion_volume"; ///< at nodes

/// Returns the message of an exception without the internal prefixes of libraries, as one line of printable
/// characters.
std::string in_plain_words(const std::exception& error);

/// Calls `visit` with every primitive of every mesh, in file order.
template <class AnyJson, class Visit>
void for_each_primitive(AnyJson& json, Visit&& visit) {
    if (json.contains("meshes"))
        for (auto& mesh : json["meshes"])
            if (mesh.contains("primitives"))
                for (auto& primitive : mesh["primitives"])
                    visit(primitive);
}

/// Returns the member `key` of `object`; creates it if it does not exist. `object[key][..]` is unsafe: if
/// memory runs out while a null becomes an object, it is left without members and cannot be destroyed
/// (nlohmann-json 3.11).
Json& member(Json& object, const char* key, Json::value_t type);
/// Returns the extension `name` of `object`; null if it does not exist.
const Json* extension_of(const Json& object, const char* name);
Json& extensions_of(Json& object);

} // namespace prt

#pragma once

// What a GltfDocument holds. Reading goes through tinygltf's model; writing edits the JSON itself, because
// tinygltf's writer drops what it does not know.

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

/// A node whose instances became nodes `first` and so on, and what it had of EXT_mesh_gpu_instancing.
struct ExpandedNode {
    std::size_t node, first, count;
    Json extension;
};

/// A mesh that node `stand_in` draws in its own frame as long as the document is in memory; in the file
/// `drawers` draw it.
struct MeshApart {
    std::size_t stand_in;
    std::vector<std::size_t> drawers;
};

struct GltfContents {
    std::filesystem::path path;
    tinygltf::Model model; ///< as read; edits of `json` do not reach it, but its views follow the bytes
    Json json;
    std::vector<std::vector<std::byte>> images; ///< encoded, by image index; empty: cannot be read
    std::vector<std::string> image_troubles;    ///< why images cannot be read, by image index
    std::vector<std::string> notices;           ///< what was changed when it was read, a line each
    std::size_t file_bytes = 0;                 ///< of the file and of the buffers beside it
    double scene_limit = 0;                     ///< GltfOptions::scene_limit
    std::vector<ExpandedNode> expanded;
    std::vector<MeshApart> apart;

    /// The one buffer that all views of `json`, and of `model`, point into.
    std::vector<unsigned char>& binary() { return model.buffers.front().data; }
    std::span<const std::byte> binary() const { return std::as_bytes(std::span(model.buffers.front().data)); }

    /// Appends bytes, aligned to 4, and a buffer view on them. `stride` 0: none. Returns the view's index.
    std::size_t add_buffer_view(std::span<const std::byte> bytes, std::size_t stride = 0,
                                bool vertices = false);
    /// Appends an accessor and returns its index.
    std::size_t add_accessor(Json accessor);
    /// Lists `name` in extensionsUsed.
    void use_extension(const std::string& name);
    /// Takes `name` out of extensionsUsed and extensionsRequired.
    void drop_extension(const std::string& name);
    /// Cuts out of the buffer what no view refers to.
    void cut_unused_bytes();
    /// Takes the extensions of prtkit about surfaces out, with their attributes, accessors and data.
    void remove_transfer();
    /// Takes the volume of prtkit out, with its data.
    void remove_volume();
    /// Takes those of `accessors` and `views` out that nothing refers to any more, with their data.
    void remove_unused(std::set<std::size_t> accessors, std::set<std::size_t> views = {});
};

inline constexpr const char* kTransferExtension = "PRTKIT_transfer";
inline constexpr const char* kClusteredExtension = "PRTKIT_clustered_pca";
inline constexpr const char* kLightmapExtension = "PRTKIT_lightmap";
inline constexpr const char* kLobeExtension = "PRTKIT_lobes";
inline constexpr const char* kVolumeExtension = "PRTKIT_transfer_volume";
inline constexpr const char* kInstancesExtension = "PRTKIT_instances"; ///< of nodes, and at the top level
inline constexpr int kInstancesVersion = 2;
inline constexpr const char* kInstancingExtension = "EXT_mesh_gpu_instancing";
inline constexpr const char* kOccluderExtension = "PRTKIT_occlusion_volume"; ///< of nodes

/// What an exception says of the file, without the inner words of the libraries that threw it, as one line of
/// printable characters.
std::string in_plain_words(const std::exception& error);

/// Calls `visit` with every primitive of every mesh, in the order of the file.
template <class AnyJson, class Visit>
void for_each_primitive(AnyJson& json, Visit&& visit) {
    if (json.contains("meshes"))
        for (auto& mesh : json["meshes"])
            if (mesh.contains("primitives"))
                for (auto& primitive : mesh["primitives"])
                    visit(primitive);
}

/// The member `key` of `object`, made if it is not there. Not by `object[key][..]`: where memory ends while a
/// null becomes an object, it is left as one without members, which cannot be destroyed (nlohmann-json 3.11).
Json& member(Json& object, const char* key, Json::value_t type);
/// The extension `name` of `object`, null where it does not have it.
const Json* extension_of(const Json& object, const char* name);
Json& extensions_of(Json& object);

} // namespace prt

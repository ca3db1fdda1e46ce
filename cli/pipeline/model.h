#pragma once

// Opens models and environment maps.

#include "cli/pipeline/host.h"
#include "cli/pipeline/reading_options.h"
#include "prt/core/error.h"
#include "prt/core/light.h"
#include "prt/core/lightmap.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/image/image_file.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace prt::pipeline {

/// Options for reading lighting, common to all commands.
struct LightOptions {
    EnvironmentOptions environment = {};
    Window window = Window::none;
    double rotation_degrees = 0;
    Notify notify = {}; ///< receives notices about images
};

/// Texels of a file, in addition to their transfer.
struct LightmapOfFile {
    LightmapLayout layout;
    /// Receivers of a bake; a compressed file has transfer of all texels.
    std::vector<std::uint32_t> texels = {};
    std::vector<float> areas = {};
    std::vector<Edge> seams = {}; ///< pairs of texels that meet at UV seams
    std::vector<Edge> edges = {}; ///< including those across seams
};

/// A glTF file with all transfer that it contains.
struct SceneFile {
    GltfDocument document;
    Scene scene;
    std::optional<BakedTransfer> baked;
    std::optional<CompressedTransfer> compressed;
    /// Set if receivers of the transfer are texels; otherwise they are vertices.
    std::optional<LightmapOfFile> lightmap = {};
    /// Volume of probes, in addition to transfer of surfaces.
    std::optional<BakedVolume> volume = {};
    std::optional<CompressedVolume> compressed_volume = {};
    std::vector<NodeOccluder> occluders = {};
    std::optional<StoredLobes> lobes = {};
    /// Set if instances share transfer: with SharedTransfer::expand, `baked` then contains it for all
    /// vertices.
    std::optional<InstancedModel> instanced = {};

    /// Returns the order of the transfer, 0 without transfer.
    int order() const;
    /// Returns the record of the bake; null without transfer.
    const BakeRecord* record() const;
};
/// Returns the layout of a model with transfer.
const TransferLayout& layout_of(const SceneFile& model);
/// A glTF file, on disk or in memory.
struct FileSource {
    Path path; ///< also the name for messages, and the folder of external files; empty: no file
    std::span<const std::byte> bytes; ///< content; empty: the file is on disk

    FileSource() = default;
    FileSource(Path of, std::span<const std::byte> content = {}) : path(std::move(of)), bytes(content) {}
    bool empty() const { return path.empty(); }
    std::string string() const { return path.string(); }
    /// Returns the size of the file in bytes. Throws std::filesystem::filesystem_error.
    std::uintmax_t size() const { return bytes.empty() ? std::filesystem::file_size(path) : bytes.size(); }
    /// Reads the file. Throws `Error`.
    GltfDocument read(const GltfOptions& options) const {
        return bytes.empty() ? load_gltf(path, options) : parse_gltf(bytes, path, options);
    }
};

/// Opens a file. A model without transfer sends the notices of its scene. Throws `Error` if any data of
/// prtkit in the file are damaged.
SceneFile load_scene_file(const FileSource& file, const ReadingOptions& options = {});
/// Returns the model of a document that was read from `path`.
SceneFile scene_file_of(GltfDocument document, const Path& path, const Notify& notify = {},
                        SharedTransfer shared = SharedTransfer::expand);
/// Returns the lightmap of a model that has one with raw transfer, and moves its data.
BakedLightmap take_baked_lightmap(SceneFile& model);

/// A model that a command writes again with additions.
struct ModelToPassOn {
    GltfDocument document;
    Scene scene;
    bool has_transfer; ///< of vertices or texels
};
/// Reads everything that `load_scene_file` reads, and sends the notices of the scene.
ModelToPassOn load_to_pass_on(const Path& path, const ReadingOptions& options);

/// Throws `Error` if the transfer is of texels, which `command` does not support.
void check_of_vertices(const SceneFile& model, const Path& path, const std::string& command);

/// Calls `work` and adds the name of `file` to its errors, once.
template <class Work>
auto about(const Path& file, Work work) {
    try {
        return work();
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        const std::string what = error.what(), name = file.string() + ": ";
        throw Error(what.starts_with(name) ? what : name + what);
    }
}

/// Puts the receivers of a bake into their order in another file of the scene, because prt compress --reorder
/// may have moved vertices.
void put_in_order_of(const Scene& scene, SceneFile& baked);

/// Returns the number of vertices of `scene` that have lobes.
std::size_t vertices_with_lobes(const Scene& scene);

/// Throws `Error` unless both files have transfer of the same order for the same receivers.
void check_belong_together(const SceneFile& baked, const Path& baked_path, const SceneFile& shipped,
                           const Path& shipped_path);

/// Loads an environment map. Sends notices about repaired and clipped values.
Environment load_environment_map(const Path& path, const EnvironmentOptions& options, const Notify& notify);

/// Returns the suffix of a file name in lower case, with the dot.
std::string suffix_of(const Path& path);

} // namespace prt::pipeline

#pragma once

// glTF 2.0 files: reads scenes, and reads and writes transfer (docs/format.md). Stable.

#include "prt/baked_transfer.h"
#include "prt/scene.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

struct GltfContents;

/// A glTF file in memory: its JSON, and all its buffers joined into one. Data that prtkit does not support is
/// preserved from `load_gltf` to `save_glb`.
class GltfDocument {
public:
    explicit GltfDocument(std::unique_ptr<GltfContents> contents);
    GltfDocument(GltfDocument&&) noexcept;
    GltfDocument& operator=(GltfDocument&&) noexcept;
    ~GltfDocument();
    GltfContents& contents() { return *contents_; }
    const GltfContents& contents() const { return *contents_; }

private:
    std::unique_ptr<GltfContents> contents_;
};

/// Representation of meshes whose instances share their transfer (PRTKIT_instances).
enum class Instancing {
    nodes,    ///< each instance is a node
    separate, ///< each mesh occurs once, in its own frame, as its transfer is stored
};

/// Settings for reading a file.
struct GltfOptions {
    /// Whether URIs may name files outside the folder of the scene: by "..", by links or by absolute paths.
    /// If false, only regular files in that folder and its subfolders are allowed.
    bool allow_outside = false;
    /// Files that will be written. A scene whose buffers or images are among them is rejected.
    std::vector<std::filesystem::path> outputs = {};
    Instancing instancing = Instancing::nodes;
    /// Factor on the intensity of the lights of KHR_lights_punctual, also in the document. Exporters write
    /// candela and lux; 1 / 683 converts them to watts.
    double lamp_scale = 1;
    /// Primitives without normals get smooth normals, also in the document: across edges whose triangles meet
    /// at this angle or less. Without a value: flat normals, as glTF requires.
    std::optional<double> smooth_normals_degrees = {};
    /// Maximum memory for the scene with its instances and morph targets, bytes. 0: 256 MB plus 64 times the
    /// size of its files, so that a small file cannot take all memory.
    double scene_limit = 0;
};

/// Reads .gltf or .glb with its buffers and images. Throws `Error` with the file and the location in it. An
/// image that cannot be read causes a notice, and an error only if its pixels are needed (`load_textures`).
GltfDocument load_gltf(const std::filesystem::path& path, const GltfOptions& options = {});

/// Reads a .gltf or .glb file in memory, with its buffers and images. `path`: location of the file, for
/// messages and to find the files that it references. Throws the errors of `load_gltf`.
GltfDocument parse_gltf(std::span<const std::byte> file, const std::filesystem::path& path,
                        const GltfOptions& options = {});

/// Returns the default scene, flattened. Every instance of a mesh gets separate vertices; skins and morph
/// targets are evaluated in the pose of the file. Throws `Error` for accessors out of bounds, indices of
/// vertices that do not exist, positions that are not finite, and a scene without triangles.
Scene extract_scene(const GltfDocument& document);

/// Writes PRTKIT_transfer into `document`, from which `scene` was extracted. Meshes that several nodes share
/// are copied per node, and primitives without normals get flat ones. Replaces existing transfer.
void write_transfer(GltfDocument& document, const Scene& scene, const BakedTransfer& baked);

/// Writes PRTKIT_clustered_pca into `document`, from which `scene` was extracted, and removes
/// PRTKIT_transfer.
void write_clustered(GltfDocument& document, const Scene& scene, const CompressedTransfer& compressed);

/// Returns the raw transfer in the file; empty if absent. Throws `Error` if it is damaged, or if its
/// instances share transfer and the file was not read with `Instancing::separate` (prt/instances_gltf.h).
std::optional<BakedTransfer> read_transfer(const GltfDocument& document, const Scene& scene);
/// Returns the compressed transfer in the file; empty if absent. Throws the errors of `read_transfer`.
std::optional<CompressedTransfer> read_clustered(const GltfDocument& document, const Scene& scene);

/// Writes `colors` [receivers] as COLOR_0, float32, which every viewer shows. Replaces existing vertex
/// colors.
void write_vertex_colors(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> colors);

/// Custom attribute of all vertices, float32.
struct VertexAttribute {
    std::string name;
    int components = 1;        ///< 1 to 4
    std::vector<float> values; ///< [receivers][components]
};

/// Returns COLOR_0 of the scene times `factors` [receivers]; with alpha if any vertices have colors.
VertexAttribute shaded_vertex_colors(const Scene& scene, std::span<const float> factors);

/// Writes `attributes`, which replace attributes of the same name. Call functions that write vertex data only
/// once per extracted scene.
void write_vertex_attributes(GltfDocument& document, const Scene& scene,
                             std::span<const VertexAttribute> attributes);

/// Occlusion and bent normals of some primitives as PNG files.
struct SurfaceTexture {
    std::vector<std::size_t> primitives; ///< indices into Scene::primitives
    int texcoord = 1;
    bool repeats = false;                ///< false: filters clamp at its border
    std::vector<std::byte> occlusion;    ///< in the red channel
    std::vector<std::byte> bent_normals; ///< n / 2 + 1/2 in the scene's frame; may be empty
};

/// Writes occlusionTexture of materials, replacing existing ones, and bent normals as
/// extras.prtkit.bentNormalTexture in the same material. A material that is used by primitives with different
/// textures is copied for each texture, also in KHR_materials_variants. Returns the number of materials that
/// had an occlusionTexture.
std::size_t write_surface_textures(GltfDocument& document, const Scene& scene,
                                   std::span<const SurfaceTexture> textures);

/// Removes all transfer from the document, and frees its memory.
void discard_transfer(GltfDocument& document);

/// Compression of vertex and index data on disk. `meshopt`: EXT_meshopt_compression, lossless; readers of the
/// file must support it. Packed weights use a code of prtkit if that is smaller.
enum class BufferCompression { none, meshopt };

/// Writes a .glb that contains all data. Throws `Error` on failure, or if it exceeds 4 GB.
void save_glb(const GltfDocument& document, const std::filesystem::path& path,
              BufferCompression compression = BufferCompression::none);

} // namespace prt

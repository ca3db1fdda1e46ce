#pragma once

// glTF 2.0 files: reading scenes, and reading and writing transfer in them (docs/format.md). Stable.

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

/// A glTF file in memory: its JSON as it stands, all its buffers joined into one. What prtkit does not know
/// survives unchanged from `load_gltf` to `save_glb`.
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

/// How meshes are read whose instances share their transfer (PRTKIT_instances).
enum class Instancing {
    nodes, ///< each instance is a node
    apart, ///< each mesh is there once, in its own frame: as its transfer is stored
};

struct GltfOptions {
    /// Whether URIs may name files outside the folder of the scene, by "..", by links or from the root.
    /// Others are regular files in that folder and below.
    bool allow_outside = false;
    /// Files that will be written: a scene whose buffers or images are among them is refused.
    std::vector<std::filesystem::path> outputs = {};
    Instancing instancing = Instancing::nodes;
    /// Factor on the intensity of the lights of KHR_lights_punctual, in the document, too: 1 / 683 makes
    /// watts of what exporters write in candela and lux.
    double lamp_scale = 1;
    /// Bytes that the scene may take with its instances and morph targets; 0: 256 MB and 64 times the size of
    /// its files, so that a small file cannot take all memory.
    double scene_limit = 0;
};

/// Reads .gltf or .glb with its buffers and images. Throws `Error` that names the file and the place in it.
/// An image that cannot be read is a notice, and an error only where its pixels are needed (`load_textures`).
GltfDocument load_gltf(const std::filesystem::path& path, const GltfOptions& options = {});

/// The same from a file in memory. `path` is where it is from: for messages, and for the files beside it.
GltfDocument parse_gltf(std::span<const std::byte> file, const std::filesystem::path& path,
                        const GltfOptions& options = {});

/// Flattens the default scene. Every node instance gets vertices of its own; skins and morph targets are
/// taken in the pose of the file. Throws `Error` for accessors out of bounds, indices beyond the vertices,
/// positions that are not finite, and a scene without triangles.
Scene extract_scene(const GltfDocument& document);

/// Writes PRTKIT_transfer into `document`, from which `scene` was extracted: meshes that several nodes share
/// get a copy per node, and primitives without normals get flat ones. Replaces any transfer that is there.
void write_transfer(GltfDocument& document, const Scene& scene, const BakedTransfer& baked);

/// Writes PRTKIT_clustered_pca and takes PRTKIT_transfer out.
void write_clustered(GltfDocument& document, const Scene& scene, const CompressedTransfer& compressed);

/// The transfer in the file; nothing when it holds none. Throws `Error` when it is damaged, and where its
/// instances share transfer, unless it was read with `Instancing::apart` (prt/instances_gltf.h).
std::optional<BakedTransfer> read_transfer(const GltfDocument& document, const Scene& scene);
std::optional<CompressedTransfer> read_clustered(const GltfDocument& document, const Scene& scene);

/// Writes `colors` [receivers] as COLOR_0, float32, in the place of vertex colors that are there: what any
/// viewer shows.
void write_vertex_colors(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> colors);

/// float32, for all vertices.
struct VertexAttribute {
    std::string name;
    int components = 1;        ///< 1 to 4
    std::vector<float> values; ///< [receivers][components]
};

/// COLOR_0 of the scene times `factors` [receivers]; with alpha where some vertices have colors.
VertexAttribute shaded_vertex_colors(const Scene& scene, std::span<const float> factors);

/// Writes them in the place of those of the same name. Like all that writes data of vertices, once for a
/// scene that was extracted.
void write_vertex_attributes(GltfDocument& document, const Scene& scene,
                             std::span<const VertexAttribute> attributes);

/// A texture that some primitives have to themselves, of PNG files.
struct SurfaceTexture {
    std::vector<std::size_t> primitives; ///< indices into Scene::primitives
    int texcoord = 1;
    bool repeats = false;                ///< else filters end at its border
    std::vector<std::byte> occlusion;    ///< in red
    std::vector<std::byte> bent_normals; ///< n / 2 + 1/2 of the scene's frame; empty: none
};

/// Writes occlusionTexture of materials, instead of those that are there, and bent normals as
/// extras.prtkit.bentNormalTexture beside it. A material that primitives of several textures have, or others,
/// gets a copy for each, and so do those of KHR_materials_variants. Returns how many had an occlusionTexture.
std::size_t write_surface_textures(GltfDocument& document, const Scene& scene,
                                   std::span<const SurfaceTexture> textures);

/// Takes all transfer out of the document, and its memory with it.
void discard_transfer(GltfDocument& document);

/// What is done with vertex and index data on disk. meshopt: EXT_meshopt_compression, without loss; a reader
/// has to know it. Packed weights are in a code of our own where that is smaller.
enum class BufferCompression { none, meshopt };

/// Writes a .glb with everything inside. Throws `Error` when it cannot, or when it would pass 4 GB.
void save_glb(const GltfDocument& document, const std::filesystem::path& path,
              BufferCompression compression = BufferCompression::none);

} // namespace prt

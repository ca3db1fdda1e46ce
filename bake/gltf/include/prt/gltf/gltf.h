#pragma once

// glTF 2.0 files: reads scenes, and reads and writes transfer (docs/format.md). Stable.

#include "prt/core/baked_transfer.h"
#include "prt/load/scene.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

struct GltfContents;

/// A glTF file in memory: its JSON, one buffer with all binary data, and its images. `save_glb` also writes
/// the data of the file that prtkit does not support. `load_gltf` and `parse_gltf` create documents. Movable,
/// not copyable. A moved-from document can only be destroyed or assigned to.
class GltfDocument {
public:
    /// For the implementation of prtkit; `GltfContents` is not a public type.
    explicit GltfDocument(std::unique_ptr<GltfContents> contents);
    GltfDocument(GltfDocument&&) noexcept;
    GltfDocument& operator=(GltfDocument&&) noexcept;
    ~GltfDocument();
    /// Returns the internal data, for the implementation of prtkit; `GltfContents` is not a public type.
    GltfContents& contents() { return *contents_; }
    const GltfContents& contents() const { return *contents_; }

private:
    std::unique_ptr<GltfContents> contents_;
};

/// How a document represents meshes whose instances share transfer (PRTKIT_instances of docs/format.md). No
/// effect on other files.
enum class Instancing {
    nodes, ///< each instance is a node, at its position in the world; `read_instanced`
           ///< (prt/gltf/transfer_gltf.h) reads shared transfer, `read_transfer` and `read_clustered` cannot
    separate, ///< each shared mesh occurs once, in its own frame; `read_transfer` and `read_clustered` read
              ///< its transfer
};

/// Settings for reading a glTF file.
struct GltfOptions {
    /// Whether the URIs of buffers and images may name files outside the folder of the scene: by "..", by
    /// links or by absolute paths. If false, only regular files in that folder and its subfolders are read.
    bool allow_outside = false;
    /// Paths of files that the caller will write. Reading throws `Error` if an external buffer or image of
    /// the scene is one of these files. Empty: no check.
    std::vector<std::filesystem::path> outputs = {};
    Instancing instancing = Instancing::nodes; ///< representation of instances that share transfer
    /// Whether scenes leave out primitives with lobes (VertexArray::lobes), so that all receivers have
    /// transfer. No effect on a file without transfer of surfaces.
    bool leave_out_lobes = false;
    /// Factor on the intensity of all lights of KHR_lights_punctual. Changes the document; saved files
    /// contain the new intensities. Exporters write candela and lux; 1 / 683 converts these to W/sr and W/m².
    double lamp_scale = 1;
    /// Angle in degrees, 0 to 180, for primitives without normals. With a value, reading adds normals to the
    /// document that are smooth across an edge if the normals of its two triangles differ by this angle or
    /// less; vertices are split at all other edges. Without a value, `extract_scene` computes flat normals,
    /// as glTF requires.
    std::optional<double> smooth_normals_degrees = {};
    /// Maximum memory in bytes for the extracted scene, with all instances and morph targets. `extract_scene`
    /// throws `Error` for more, and `load_gltf` if the nodes of instances alone need more. 0: the limit is
    /// 256 MB plus 64 times the size of the file and its external buffers, so that a small file cannot use
    /// all memory.
    double scene_limit = 0;
};

/// Reads a .gltf or .glb file with its buffers and encoded images. Throws `Error`, with the path, if the file
/// or an external buffer cannot be read, is damaged or is too large, if the file requires an unsupported
/// extension, or if it uses a file of GltfOptions::outputs. An image file that cannot be read does not throw
/// here: it causes a line in Scene::notices, and an `Error` of `load_textures` if its pixels are needed.
/// Replaces unusable normals and texture coordinates in the document. If `prt compress --fallback` wrote
/// vertex colors for other viewers, restores the original colors and materials (docs/format.md, "Fallback").
GltfDocument load_gltf(const std::filesystem::path& path, const GltfOptions& options = {});

/// Reads a .gltf or .glb file whose bytes `file` are in memory. `path`: path that the file has or would have,
/// for messages, and to find external buffers and images in its folder; the file itself is not opened. Keeps
/// no reference to `file`. Throws the errors of `load_gltf`.
GltfDocument parse_gltf(std::span<const std::byte> file, const std::filesystem::path& path,
                        const GltfOptions& options = {});

/// Returns the default scene of the file (scene 0 if there is no default, all nodes if there are no scenes),
/// flattened: vertices have world axes, and positions relative to Scene::origin. Every instance of a mesh
/// gets separate vertices. Skins and morph targets are evaluated in the pose of the file. Hidden nodes,
/// coarser levels of detail, points and lines are left out. Throws `Error`, with the path, if the nodes,
/// meshes, skins, materials or lights are invalid, a position is not finite or exceeds kFarthestVertex, the
/// scene has no triangles, or it exceeds GltfOptions::scene_limit.
Scene extract_scene(const GltfDocument& document);

/// Writes raw transfer of vertices (PRTKIT_transfer) into `document`, from which `scene` was extracted.
/// First removes what `discard_transfer` removes. Writes no transfer for vertices that have lobes
/// (VertexArray::lobes). Changes the meshes: a mesh that several nodes draw is
/// copied for each node, and primitives without normals get flat normals. Per document, call at most one
/// function that changes meshes. Throws `Error` if the copies exceed the memory limit of docs/format.md.
void write_transfer(GltfDocument& document, const Scene& scene, const BakedTransfer& baked);

/// Writes compressed transfer of vertices (PRTKIT_transfer) into `document`, from which `scene` was
/// extracted. First removes what `discard_transfer` removes. Writes no transfer for vertices that have lobes.
/// Changes the meshes as `write_transfer` does; per document, call at most one function that changes meshes.
/// Throws the errors of `write_transfer`.
void write_clustered(GltfDocument& document, const Scene& scene, const CompressedTransfer& compressed);

/// Returns the raw transfer of vertices in `document`, from which `scene` was extracted. Returns no value if
/// the file has no such transfer. Throws `Error` if the transfer is damaged, too large or of another
/// version, or if instances share it and the file was read with `Instancing::nodes`
/// (prt/gltf/transfer_gltf.h).
std::optional<BakedTransfer> read_transfer(const GltfDocument& document, const Scene& scene);
/// Returns the compressed transfer of vertices in `document`, from which `scene` was extracted. Returns no
/// value if the file has no such transfer. Throws `Error` if the transfer is damaged, too large or of
/// another version, or if instances share it and the file was read with `Instancing::nodes`
/// (prt/gltf/transfer_gltf.h). Also throws if the file has attributes _PRT_WEIGHTS_n or _PRT_CLUSTER, but no
/// extension of prtkit.
std::optional<CompressedTransfer> read_clustered(const GltfDocument& document, const Scene& scene);

/// Writes vertex colors (attribute COLOR_0, three float32 numbers, linear) into `document`, from which
/// `scene` was extracted. Every glTF viewer shows the colors, multiplied by the base color. `colors`:
/// [receivers of `scene`]. Replaces existing vertex colors and their alpha. Changes the meshes as
/// `write_transfer` does; per document, call at most one function that changes meshes. To write more, save
/// the document and read the file again. Throws the errors of `write_transfer`.
void write_vertex_colors(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> colors);

/// Attribute of all vertices of a scene, as float32 numbers.
struct VertexAttribute {
    std::string name;          ///< name of the glTF attribute, such as "COLOR_0"; custom names begin with '_'
    int components = 1;        ///< numbers per vertex, 1 to 4
    std::vector<float> values; ///< [receivers of the scene][components]
};

/// Returns the attribute COLOR_0: the red, green and blue of each vertex color of `scene` (white if a vertex
/// has no color) times the factor of the vertex. `factors`: [receivers of `scene`]. The attribute has four
/// components, with the alpha of the file, if any vertex array has colors; otherwise three.
VertexAttribute shaded_vertex_colors(const Scene& scene, std::span<const float> factors);

/// Writes `attributes` of vertices into `document`, from which `scene` was extracted. Replaces existing
/// attributes of the same name. Changes the meshes as `write_transfer` does; call only one function that
/// changes the meshes per document. To write more, save the document and read the file again. Throws the
/// errors of `write_transfer`.
void write_vertex_attributes(GltfDocument& document, const Scene& scene,
                             std::span<const VertexAttribute> attributes);

/// Ambient occlusion and bent normals of some primitives, as encoded PNG files.
struct SurfaceTexture {
    std::vector<std::size_t> primitives; ///< primitives that use the textures, indices into Scene::primitives
    int texcoord = 1;                    ///< UV set of the textures: TEXCOORD_n
    bool repeats = false;                ///< wrapping outside 0..1; true: repeat, false: clamp to the edge
    std::vector<std::byte> occlusion;    ///< PNG file; ambient visibility in red, 1 is unoccluded
    std::vector<std::byte> bent_normals; ///< PNG file; RGB is n / 2 + 1/2 for a unit vector n in the frame of
                                         ///< the scene; empty: no bent normals
};

/// Embeds `textures` in `document`, from which `scene` was extracted. The materials of the primitives get the
/// occlusion as occlusionTexture, and the bent normals as extras.prtkit.bentNormalTexture. If primitives with
/// different textures, or without one, share a material, each texture gets a copy of the material, also in
/// KHR_materials_variants. Primitives without a material get a new one. Replaces existing occlusionTextures
/// and returns the number of materials, with their copies, that had one. Changes the meshes as
/// `write_transfer` does; per document, call at most one function that changes meshes. Throws the errors of
/// `write_transfer`, and `Error` if bent normals are written and `extras` or extras.prtkit of a material is
/// not an object.
std::size_t write_surface_textures(GltfDocument& document, const Scene& scene,
                                   std::span<const SurfaceTexture> textures);

/// Removes the transfer of vertices and lightmaps, and PRTKIT_instances from `document`, with their data, and
/// frees the memory. Keeps PRTKIT_instances if the document was read with `Instancing::separate`. Keeps
/// lobes, probe volumes and occlusion volumes.
void discard_transfer(GltfDocument& document);

/// Removes the lobes of figures from `document`, and frees the memory.
void discard_lobes(GltfDocument& document);

/// Compression of vertex and index data in a .glb file.
enum class BufferCompression {
    none,   ///< any glTF reader can read the file
    meshopt ///< EXT_meshopt_compression, lossless; readers must support it. Packed weights
            ///< are stored in a code of prtkit (docs/format.md) instead if the file becomes smaller
};

/// Writes `document` to the .glb file `path`, with all buffers and all images that could be read embedded.
/// Replaces an existing file only if writing succeeds. Throws `Error` if the file cannot be written, or if it
/// would exceed 4 GB.
void save_glb(const GltfDocument& document, const std::filesystem::path& path,
              BufferCompression compression = BufferCompression::none);

} // namespace prt

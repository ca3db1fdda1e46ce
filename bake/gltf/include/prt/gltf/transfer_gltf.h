#pragma once

// Transfer other than that of vertices in glTF files (docs/format.md): lightmaps, probe volumes, instances
// that share the transfer of their mesh, lobes, and occlusion volumes. Experimental.

#include "prt/core/instances.h"
#include "prt/core/lightmap.h"
#include "prt/core/lobes.h"
#include "prt/core/occlusion_volume.h"
#include "prt/core/transfer_volume.h"
#include "prt/gltf/gltf.h"
#include "prt/load/model.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// A node that draws a mesh, with the rotation and the uniform scale of its transform to the world. The
/// translation is not stored.
struct MeshPlacement {
    int node = 0;           ///< index in the nodes of the GltfDocument
    glm::dmat3 rotation{1}; ///< from the mesh's frame to the world's
    double scale = 1;       ///< length in the world over length in the mesh's frame; positive
};

/// A mesh, and the nodes that draw it with a rotation, a uniform scale and a translation.
struct SharedMesh {
    int mesh = 0;                          ///< index in the meshes of the GltfDocument
    std::vector<MeshPlacement> placements; ///< in the order in which Scene::primitives contains the nodes
};

/// Meshes of a scene whose instances can share transfer, and numbers of nodes that cannot share it although
/// they draw the same mesh as another node.
struct SharedMeshes {
    std::vector<SharedMesh> meshes; ///< meshes with at least two placements, in ascending order of the mesh
    std::size_t mirrored = 0, ///< number of nodes left out: they mirror a mesh that other nodes also draw
        uneven = 0, ///< number of nodes left out: they draw a mesh that other nodes also draw, with a
                    ///< singular, sheared or non-uniform scale
        bent = 0;   ///< number of nodes left out: a skin or morph targets deform their mesh, which
                    ///< other nodes also draw

    /// Returns the total number of placements of all `meshes`.
    std::size_t placements() const;
};
/// Finds the meshes that at least two nodes draw with a rotation, a uniform scale and a translation, without
/// a skin or morph targets. Instances of these meshes can share transfer. `document` was read with
/// `Instancing::nodes`; `scene` was extracted from `document`.
SharedMeshes shared_meshes(const GltfDocument& document, const Scene& scene);

/// A document in which each shared mesh occurs once: the result of `with_shared_meshes`.
struct SharedDocument {
    /// The document in the form of `Instancing::separate`: one additional node draws each shared mesh, in the
    /// mesh's own frame. Contains no transfer of surfaces.
    GltfDocument document;
    std::vector<int> mesh_nodes; ///< [shared meshes] index in `document` of the node that draws the mesh
    std::vector<int> node_of;    ///< [nodes of the source document] index of the node in `document`; -1 if
                                 ///< EXT_mesh_gpu_instancing replaces the node there
};
/// Returns a copy of `document` in which the instances of `meshes` share transfer. `document` must be read
/// with `Instancing::nodes`. Instances are numbered mesh by mesh, and within a mesh placement by placement.
/// Call `write_instances` for the result before you save it. Throws the errors of `parse_gltf`.
SharedDocument with_shared_meshes(const GltfDocument& document, const std::vector<SharedMesh>& meshes);

/// Writes `instances` into `document`, a result of `with_shared_meshes`, with the same numbers of instances
/// and meshes. Each number of the factors and of the light of lamps is rounded to one byte. Throws `Error` if
/// a number is not finite, or if the magnitude of a factor exceeds `kMaxInstanceFactor`. Does not check the
/// boxes; files need half sizes greater than 0.
void write_instances(GltfDocument& document, const StoredInstances& instances);

/// Returns whether instances of the file share transfer and `document` was read with `Instancing::nodes`. If
/// true, `read_instanced` reads the transfer of the file; `read_transfer` and `read_clustered` cannot.
bool shares_instances(const GltfDocument& document);

/// Returns whether instances of the file share transfer (PRTKIT_instances). The result does not depend on the
/// `Instancing` with which `document` was read.
bool holds_instances(const GltfDocument& document);

/// Returns the instances of the file in ascending order of their nodes. `document` was read with
/// `Instancing::nodes`, and `scene` was extracted from it. `stored` is the scene of the same file read with
/// `Instancing::separate`. `holds_instances(document)` must be true. Throws `Error` if PRTKIT_instances is
/// damaged or of another version, if an instance has a mirrored, sheared, singular or non-uniform scale, or
/// if the numbers of vertices in `scene` and `stored` do not match.
std::vector<FileInstance> read_instances(const GltfDocument& document, const Scene& scene,
                                         const Scene& stored);

/// Contents of a file whose instances share transfer.
struct InstancedModel {
    /// The scene of the file, read with `Instancing::separate`: each shared mesh once, in its own frame; all
    /// other meshes in the world's frame.
    Scene stored;
    /// Raw transfer of the receivers of `stored`; empty if the file has no raw transfer.
    std::optional<BakedTransfer> baked;
    /// Compressed transfer of the receivers of `stored`; empty if the file has no compressed transfer.
    std::optional<CompressedTransfer> compressed;
    /// All instances of shared meshes, in ascending order of their nodes.
    std::vector<FileInstance> instances;
};
/// Returns the contents of the file of `document`. `document` must be read with `Instancing::nodes`, `scene`
/// must be extracted from it, and `shares_instances(document)` must be true. `path` is the name of the file,
/// for messages. Throws the errors of `parse_gltf`, `extract_scene`, `read_transfer`, `read_clustered` and
/// `read_instances`, and `Error` if the file has no transfer of vertices.
InstancedModel read_instanced(const GltfDocument& document, const Scene& scene,
                              const std::filesystem::path& path);

/// Returns the instances of `model` in the form that InstanceRelighter needs, in the order of
/// `model.instances`. `model.compressed` must have a value. Boxes are relative to
/// `model.stored.origin` - `seen_from`. With the default, positions in the vertex shader are those of
/// `model.stored`; with `seen_from` = `model.stored.origin` they are those of the file, as shaders of `prt
/// shader --stage instances` require.
std::vector<RelitInstance> relit_instances(const InstancedModel& model,
                                           const glm::dvec3& seen_from = glm::dvec3(0));
/// Returns areas in m², [receivers of `stored`]: the area of the receiver itself, or for a receiver of a
/// shared mesh the sum of its areas in all instances at their scales. `document` was read with
/// `Instancing::separate`, and `stored` was extracted from it. Throws `Error` if a sum exceeds 1e18 times the
/// area in the mesh's frame, or if the hierarchy of nodes or EXT_mesh_gpu_instancing is damaged.
std::vector<float> instanced_areas(const GltfDocument& document, const Scene& stored);

/// Returns the transfer of all receivers of `scene`, in the world's frame. The transfer of an instance is
/// computed from the transfer of its mesh and from its factors. `transfer` has the receivers of `stored`. The
/// other arguments are those of `read_instances`. `threads` 0: all hardware threads. Throws the errors of
/// `read_instances` and of the constructor of `SharedTransfer`, and `Error` if the result exceeds the memory
/// limit of docs/format.md.
Transfer expanded(const GltfDocument& document, const Scene& scene, const Scene& stored,
                  const Transfer& transfer, int threads = 0);

/// Writes raw transfer of texels into `document`, from which `scene` was extracted. Removes all existing
/// transfer of surfaces, except lobes; surfaces with lobes get no texels. Changes the meshes as
/// `write_transfer` does; call only one function that changes the meshes per document. Throws the errors of
/// `write_transfer`.
void write_lightmap(GltfDocument& document, const Scene& scene, const BakedLightmap& lightmap);

/// Returns the raw transfer of texels in the file; empty if the file has no lightmap or a compressed one.
/// `scene` was extracted from `document`. Throws `Error` if the lightmap is damaged, too large or of another
/// version, or if the file also has transfer of vertices.
std::optional<BakedLightmap> read_lightmap(const GltfDocument& document, const Scene& scene);

/// Writes a compressed lightmap with encoded images into `document`, from which `scene` was extracted.
/// `lightmap` must have at least one map and packed weights. Removes all existing transfer of surfaces and
/// changes the meshes, as `write_lightmap` does. Throws the errors of `write_transfer`.
/// prt/render/lightmap_file.h has functions that encode the images.
void write_encoded_lightmap(GltfDocument& document, const Scene& scene, const EncodedLightmap& lightmap);
/// Returns the compressed lightmap in the file, with encoded images; empty if the file has no lightmap or a
/// raw one. `scene` was extracted from `document`. Throws the errors of `read_lightmap`; does not decode the
/// images. prt/render/lightmap_file.h has functions that decode them.
std::optional<EncodedLightmap> read_encoded_lightmap(const GltfDocument& document, const Scene& scene);

/// Writes a raw volume, whose grid is relative to Scene::origin, into `document`, from which `scene` was
/// extracted. Replaces an existing volume, raw or compressed. Does not change transfer of surfaces.
void write_volume(GltfDocument& document, const Scene& scene, const BakedVolume& volume);
/// Writes a compressed volume, whose grid is relative to Scene::origin, into `document`, from which `scene`
/// was extracted. Replaces an existing volume, raw or compressed. Does not change transfer of surfaces.
/// Throws `Error` unless the weights are packed.
void write_volume(GltfDocument& document, const Scene& scene, const CompressedVolume& volume);

/// Returns the raw volume in the file; empty if the file has no volume or a compressed one. `scene` was
/// extracted from `document`. Throws `Error` if the volume is damaged, too large or of another version.
std::optional<BakedVolume> read_volume(const GltfDocument& document, const Scene& scene);
/// Returns the compressed volume in the file; empty if the file has no volume or a raw one. `scene` was
/// extracted from `document`. Throws `Error` if the volume is damaged, too large or of another version.
std::optional<CompressedVolume> read_compressed_volume(const GltfDocument& document, const Scene& scene);

/// Removes the volume, raw or compressed, from `document`, and frees its memory. Does nothing if there is no
/// volume.
void discard_volume(GltfDocument& document);

/// Writes lobes of the vertex arrays with VertexArray::lobes into `document`, from which `scene` was
/// extracted (the caller can change VertexArray::lobes). Replaces all existing lobes, and the transfer of
/// these vertices in vertices, lightmaps and shared instances, which is valid for a single pose only; keeps
/// all other transfer. Changes the meshes of these vertices as `write_transfer` does; call only one function
/// that changes the meshes per document. Throws the errors of `check_lobes` and `write_transfer`.
void write_lobes(GltfDocument& document, const Scene& scene, const StoredLobes& lobes);

/// Returns whether the file has lobes. Does not read them.
bool has_lobes(const GltfDocument& document);

/// Returns the lobes in the file, with words of 0 for vertices without lobes; empty if the file has no lobes.
/// `scene` was extracted from `document`. Throws `Error` if the lobes are damaged, too large or of another
/// version.
std::optional<StoredLobes> read_lobes(const GltfDocument& document, const Scene& scene);

/// Removes all occlusion volumes from `document`, then writes `occluders`, which contain at most one for each
/// node. Throws `Error` if a node does not exist; `document` is then partly changed. Does not check the
/// volumes (`check_occlusion_volume`).
void write_occluders(GltfDocument& document, std::span<const NodeOccluder> occluders);

/// Returns the occlusion volumes in the file, in ascending order of their nodes; empty if the file has no
/// occlusion volumes. Throws `Error` if an occlusion volume is damaged or of another version.
std::vector<NodeOccluder> read_occluders(const GltfDocument& document);

} // namespace prt

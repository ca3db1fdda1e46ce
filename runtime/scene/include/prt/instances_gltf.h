#pragma once

// Meshes that several nodes draw, and files whose instances share transfer (PRTKIT_instances of
// docs/format.md). Experimental.

#include "prt/gltf.h"
#include "prt/instance_relighter.h"
#include "prt/instances.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace prt {

/// A node that draws a mesh with a rotation, a uniform scale and a translation.
struct MeshPlacement {
    int node = 0;
    glm::dmat3 rotation{1}; ///< from the mesh's frame to the world's
    double scale = 1;
};

/// A mesh, and the nodes that draw it with a rotation, a uniform scale and a translation, in the order of the
/// scene.
struct SharedMesh {
    int mesh = 0;
    std::vector<MeshPlacement> placements;
};

/// Meshes of a scene whose instances can share transfer.
struct SharedMeshes {
    std::vector<SharedMesh> meshes; ///< meshes with at least two placements
    /// Numbers of nodes that cannot share the transfer of a mesh, although other nodes also draw it.
    /// `mirrored`: the transform mirrors; `uneven`: the scale is singular or non-uniform; `bent`: skins or
    /// morph targets deform the mesh.
    std::size_t mirrored = 0, uneven = 0, bent = 0;

    /// Returns the number of placements of all meshes.
    std::size_t placements() const;
};
/// Finds the meshes of `document` whose instances can share transfer. `scene` was extracted from it.
SharedMeshes shared_meshes(const GltfDocument& document, const Scene& scene);

/// A document for writing in which shared meshes occur once.
struct SharedDocument {
    GltfDocument document;       ///< must be read with `Instancing::separate`
    std::vector<int> mesh_nodes; ///< [meshes] the node in `document` that draws the mesh in its own frame
    std::vector<int> node_of;    ///< [nodes of the flat document] node in `document`; -1 for an instance
};
/// Returns a document in which the instances of `meshes` share their transfer. Instances are numbered mesh by
/// mesh, and within a mesh placement by placement. Every other node gets a separate mesh. `document` must be
/// read with `Instancing::nodes`.
SharedDocument with_shared_meshes(const GltfDocument& document, const std::vector<SharedMesh>& meshes);

/// Instances as stored in a file: factors [instances], and boxes [meshes] of their meshes.
struct StoredInstances {
    std::vector<InstanceFactors> factors;
    std::vector<InstanceBox> boxes;
};
/// Writes the instances, one byte per number, into a document of `with_shared_meshes`. Throws `Error` for
/// factors outside the range of files.
void write_instances(GltfDocument& document, const StoredInstances& instances);

/// Returns whether instances of the file share transfer and the document was read with `Instancing::nodes`.
/// `expanded` then computes the transfer of the instances.
bool shares_instances(const GltfDocument& document);

/// Returns whether instances of the file share transfer, for any `Instancing` with which the document was
/// read.
bool holds_instances(const GltfDocument& document);

/// An instance in the scene of a document that was read with `Instancing::nodes`.
struct FileInstance {
    int node = 0;
    std::size_t number = 0; ///< index in the file
    PlacedInstance placed;
    /// Vertex arrays of the instance, and for each the array of the stored scene that has the transfer of its
    /// mesh.
    std::vector<std::size_t> arrays, stored_arrays;
    glm::dmat4 world{1}; ///< matrix of the node
};
/// Returns the instances of the file, with their nodes, factors, rotations, boxes and vertex arrays.
/// `document` and `scene` are read with `Instancing::nodes`; `stored` is the scene of the same file read with
/// `Instancing::separate`. Throws `Error` if the extension is damaged, or if a node mirrors its mesh or
/// scales it non-uniformly.
std::vector<FileInstance> read_instances(const GltfDocument& document, const Scene& scene,
                                         const Scene& stored);

/// Contents of a file whose instances share transfer, as stored: each mesh once, in its own frame.
struct InstancedModel {
    Scene stored;
    std::optional<BakedTransfer> baked; ///< raw transfer of the receivers of `stored`, if the file has it
    std::optional<CompressedTransfer> compressed; ///< compressed transfer, if the file has it
    std::vector<FileInstance> instances;
};
/// Returns the model of `document`, which was read from `path`. `document` and `scene` must be read with
/// `Instancing::nodes`, and `shares_instances` must be true. Throws the errors of `read_instances`, and
/// `Error` if there is no transfer.
InstancedModel read_instanced(const GltfDocument& document, const Scene& scene,
                              const std::filesystem::path& path);

/// Returns the instances of a compressed model for InstanceRelighter. Boxes are relative to the origin of the
/// scene `stored`.
std::vector<RelitInstance> relit_instances(const InstancedModel& model);
/// Returns the instances for InstanceRelighter from the members of an InstancedModel.
std::vector<RelitInstance> relit_instances(std::span<const FileInstance> instances, const Scene& stored,
                                           const ClusteredTransfer& transfer);

/// Returns the areas of the receivers of `stored`, the scene of `document` with each mesh once, m². For
/// meshes with instances they are summed over all instances at their scales.
std::vector<float> instanced_areas(const GltfDocument& document, const Scene& stored);

/// Returns the transfer of all receivers of `scene`, in the world's frame. Transfer of instances is computed
/// from the transfer of their mesh and their factors. `transfer` has the receivers of `stored`.
Transfer expanded(const GltfDocument& document, const Scene& scene, const Scene& stored,
                  const Transfer& transfer, int threads = 0);

} // namespace prt

#pragma once

// Meshes that are drawn several times, and files whose instances share transfer (PRTKIT_instances of
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

/// A mesh, and the nodes of the scene that draw it with such a transform, in the order of the scene.
struct SharedMesh {
    int mesh = 0;
    std::vector<MeshPlacement> placements;
};

struct SharedMeshes {
    std::vector<SharedMesh> meshes; ///< meshes with at least two placements
    /// Number of nodes that draw a mesh which other nodes also draw, but cannot share its transfer: mirrored;
    /// singular or non-uniform scale; deformed by skins or morph targets.
    std::size_t mirrored = 0, uneven = 0, bent = 0;

    std::size_t placements() const;
};
SharedMeshes shared_meshes(const GltfDocument& document, const Scene& scene);

/// A document for writing in which shared meshes occur once.
struct SharedDocument {
    GltfDocument document;      ///< must be read with `Instancing::separate`
    std::vector<int> stand_ins; ///< [meshes] the node in `document` that draws the mesh in its own frame
    std::vector<int> node_of;   ///< [nodes of the flat document] node in `document`; -1 for an instance
};
/// Makes the instances of `meshes` share their transfer. Instances are numbered mesh by mesh, placement by
/// placement. `document` must be read with `Instancing::nodes`. All other nodes get a separate mesh.
SharedDocument with_shared_meshes(const GltfDocument& document, const std::vector<SharedMesh>& meshes);

/// Factors [instances], and boxes [meshes] of their meshes.
struct StoredInstances {
    std::vector<InstanceFactors> factors;
    std::vector<InstanceBox> boxes;
};
/// Writes the instances, one byte per number, into a document of `with_shared_meshes`. Throws `Error` for
/// factors outside the range of files.
void write_instances(GltfDocument& document, const StoredInstances& instances);

/// Returns whether instances of the file share transfer and are represented as nodes; their transfer requires
/// `expanded`.
bool shares_instances(const GltfDocument& document);

/// Returns whether instances of the file share transfer, in any representation.
bool holds_instances(const GltfDocument& document);

/// An instance in the scene of a document that was read with `Instancing::nodes`.
struct FileInstance {
    int node = 0;
    std::size_t number = 0; ///< index in the file
    PlacedInstance placed;
    /// Its vertex arrays, and the arrays of the stored scene with the transfer of its mesh.
    std::vector<std::size_t> arrays, stored_arrays;
    glm::dmat4 world{1}; ///< matrix of the node
};
/// Reads the instances. `document` and `scene` are read with `Instancing::nodes`; `stored` is the scene of
/// the same file read with `Instancing::separate`. Throws `Error` if the extension is damaged, or if the
/// matrix of a node does not fit its instance.
std::vector<FileInstance> read_instances(const GltfDocument& document, const Scene& scene,
                                         const Scene& stored);

/// Contents of a file whose instances share transfer, as stored: each mesh once, in its own frame.
struct InstancedModel {
    Scene stored;
    std::optional<BakedTransfer> baked; ///< transfer of the receivers of `stored`; either this
    std::optional<CompressedTransfer> compressed;
    std::vector<FileInstance> instances;
};
/// Reads the model of `document`, from `path`. `document` and `scene` must be read with `Instancing::nodes`,
/// and `shares_instances` must be true. Throws `Error` as `read_instances`, and if there is no transfer.
InstancedModel read_instanced(const GltfDocument& document, const Scene& scene,
                              const std::filesystem::path& path);

/// Returns the instances of a compressed model for InstanceRelighter. Boxes refer to positions as in
/// `stored`.
std::vector<RelitInstance> relit_instances(const InstancedModel& model);
/// Returns the instances for InstanceRelighter, from the parts of an InstancedModel.
std::vector<RelitInstance> relit_instances(std::span<const FileInstance> instances, const Scene& stored,
                                           const ClusteredTransfer& transfer);

/// Returns areas of the receivers of `stored`, the scene of `document` with each mesh once. For meshes with
/// instances, the areas are summed over all instances, with their scale.
std::vector<float> instanced_areas(const GltfDocument& document, const Scene& stored);

/// Returns the transfer of all receivers of `scene`, in the world's frame. Transfer of instances is computed
/// from the transfer of their mesh and their factors. `transfer` has the receivers of `stored`.
Transfer expanded(const GltfDocument& document, const Scene& scene, const Scene& stored,
                  const Transfer& transfer, int threads = 0);

} // namespace prt

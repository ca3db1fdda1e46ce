#pragma once

// Meshes that are drawn often, and files whose instances share transfer (PRTKIT_instances of docs/format.md).
// Experimental.

#include "prt/gltf.h"
#include "prt/instance_former.h"
#include "prt/instances.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace prt {

/// A node that draws a mesh turned, scaled evenly and moved.
struct MeshPlacement {
    int node = 0;
    glm::dmat3 rotation{1}; ///< from the mesh's frame into the world's
    double scale = 1;
};

/// A mesh, and the nodes of the scene that draw it so, in the order of the scene.
struct SharedMesh {
    int mesh = 0;
    std::vector<MeshPlacement> placements;
};

struct SharedMeshes {
    std::vector<SharedMesh> meshes; ///< with two placements at least
    /// Nodes that draw a mesh which others draw, too, and cannot share: their matrices mirror, are singular
    /// or scale unevenly; skins or morph targets bend them.
    std::size_t mirrored = 0, uneven = 0, bent = 0;

    std::size_t placements() const;
};
SharedMeshes shared_meshes(const GltfDocument& document, const Scene& scene);

/// A document with meshes apart, for writing.
struct SharedDocument {
    GltfDocument document;      ///< as read with `Instancing::apart`
    std::vector<int> stand_ins; ///< [meshes] the node in `document` that draws the mesh in its own frame
    std::vector<int> node_of;   ///< [nodes of the flat document] in `document`, -1: is an instance
};
/// Lets `meshes` share their transfer; instances are numbered mesh by mesh, placement by placement.
/// `document` was read with `Instancing::nodes`. Nodes that are in none of them keep a mesh of their own.
SharedDocument with_shared_meshes(const GltfDocument& document, const std::vector<SharedMesh>& meshes);

/// [instances], and the boxes [meshes] of their meshes.
struct StoredInstances {
    std::vector<InstanceFactors> factors;
    std::vector<InstanceBox> boxes;
};
/// Writes them, a byte for each number, into a document with meshes apart. Throws `Error` for factors that
/// files do not hold.
void write_instances(GltfDocument& document, const StoredInstances& instances);

/// Whether instances of the file share transfer and are nodes here: `expanded` makes theirs.
bool shares_instances(const GltfDocument& document);

/// Whether they share it at all.
bool holds_instances(const GltfDocument& document);

/// An instance in the scene of a document that was read with `Instancing::nodes`.
struct FileInstance {
    int node = 0;
    std::size_t number = 0; ///< in the file
    PlacedInstance placed;
    /// Its vertex arrays, and those of the stored scene with the transfer of its mesh.
    std::vector<std::size_t> arrays, stored_arrays;
    glm::dmat4 world{1}; ///< of the node
};
/// `document` and `scene` as read with `Instancing::nodes`, `stored` the scene of the same file with its
/// meshes apart. Throws `Error` where the extension is damaged, and where a matrix does not fit an instance.
std::vector<FileInstance> read_instances(const GltfDocument& document, const Scene& scene,
                                         const Scene& stored);

/// What a file holds whose instances share transfer, as it is stored: meshes once, in their own frames.
struct InstancedModel {
    Scene stored;
    std::optional<BakedTransfer> baked; ///< of its receivers; or
    std::optional<CompressedTransfer> compressed;
    std::vector<FileInstance> instances;
};
/// `document`, of `path`, and `scene` as read with `Instancing::nodes`, where `shares_instances`. Throws
/// `Error` as `read_instances`, and where there is no transfer.
InstancedModel read_instanced(const GltfDocument& document, const Scene& scene,
                              const std::filesystem::path& path);

/// What constants are formed for, of a compressed model; places are those of positions as `stored` has them.
std::vector<FormedInstance> formed_instances(const InstancedModel& model);
/// The same of the parts of one.
std::vector<FormedInstance> formed_instances(std::span<const FileInstance> instances, const Scene& stored,
                                             const ClusteredTransfer& transfer);

/// Areas of the receivers of `stored`, the scene of `document` with its meshes apart: those of a mesh that
/// instances share as large as it is drawn, and as often.
std::vector<float> shown_areas(const GltfDocument& document, const Scene& stored);

/// Transfer of all receivers of `scene`, in the world's frame: that of instances is what their mesh's becomes
/// where they stand. `transfer`: of the receivers of `stored`.
Transfer expanded(const GltfDocument& document, const Scene& scene, const Scene& stored,
                  const Transfer& transfer, int threads = 0);

} // namespace prt

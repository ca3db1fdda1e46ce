#pragma once

// Instances that share the transfer of their mesh.

#include "prt/load/model.h"
#include "runtime/load/gltf_data.h"

#include <span>
#include <vector>

namespace prt {

inline constexpr int kInstancesVersion = 3, kMaxSharedInstances = 1'000'000;

/// Reads PRTKIT_instances. Throws `Error` if it is missing, damaged or of another version.
StoredInstances read_stored_instances(const GltfData& data);

/// Returns the instance of a node with the extension, without its vertex arrays. Throws `Error` if the
/// extension is damaged, or if `world`, the matrix of the node, does not only rotate, scale uniformly and
/// translate.
FileInstance read_instance(const StoredInstances& stored, int node, const Json& extension,
                           const glm::dmat4& world);

/// An instance, and the mesh that it draws.
struct MeshInstance {
    FileInstance instance;
    int mesh;
};
/// Returns the visible instances that share transfer, in ascending order of their nodes. The nodes must be
/// expanded (`expand_instances`), and draw their meshes themselves.
std::vector<MeshInstance> mesh_instances(const GltfData& data);

/// Throws `Error` unless each instance has the light of each lamp of `layout`, that of its transfer.
void check_instance_lamps(const TransferLayout& layout, std::span<const FileInstance> instances);

} // namespace prt

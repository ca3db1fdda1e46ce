#pragma once

// Separate meshes for nodes.

#include "bake/gltf/contents.h"
#include "prt/load/scene.h"

namespace prt {

/// Nodes whose meshes are changed: all, or only those with lobes (VertexArray::lobes).
enum class ChangedMeshes { all, with_lobes };

/// Changes the file so that each vertex of `changed` nodes is one vertex of the scene, and data per receiver
/// can be attached: meshes that several nodes share are copied per node, and primitives whose vertices were
/// split for flat normals are rewritten as triangles. Returns the JSON of each scene primitive in `contents`.
std::vector<Json*> make_meshes_unique(GltfContents& contents, const Scene& scene,
                                      ChangedMeshes changed = ChangedMeshes::all);

/// Calls `make_meshes_unique`, and removes the transfer of the `changed` nodes; if these are all nodes of the
/// scene, also that of all others in the file. Lobes and the transfer of probes remain.
std::vector<Json*> meshes_without_transfer(GltfContents& contents, const Scene& scene,
                                           ChangedMeshes changed = ChangedMeshes::all);

/// Rewrites a primitive: vertex i is a copy of vertex source[i] with normals[i], in all attributes and morph
/// targets except tangents and changes of normals.
void replace_vertices(GltfContents& contents, Json& primitive, const std::vector<std::uint32_t>& source,
                      std::span<const glm::vec3> normals, std::span<const glm::uvec3> triangles);

} // namespace prt

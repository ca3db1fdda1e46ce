#pragma once

// Receivers: the points for which the baker computes transfer.

#include "prt/core/transfer.h"
#include "prt/load/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace prt {

/// Points for which the baker computes transfer: vertices, samples of a surface, texels or probes. Every
/// array has one entry per receiver, at the index of the receiver.
struct Receivers {
    std::vector<glm::vec3> positions; ///< [receivers] metres, relative to Scene::origin
    std::vector<glm::vec3> normals;   ///< [receivers] unit; zero: no normal, rays are not traced
    std::vector<float> areas;         ///< [receivers] m², 1 for probes; 0: rays are not traced
    /// [receivers] ray origin minus position, in units of RayScene::surface_offset; empty: `normals` are used
    /// instead. Vertices need this array, because their normals may point below an adjacent triangle.
    std::vector<glm::vec3> starts = {};

    std::size_t size() const { return positions.size(); }
    /// Appends a copy of receiver `index` of `from`. `starts` must be empty in both lists or filled in both;
    /// the first receiver may be appended to an empty list in any case.
    void append(const Receivers& from, std::size_t index);
};

/// Returns all vertices of the scene as receivers, in the order of Scene::vertex_arrays, with `starts`. The
/// area of a vertex is a third of the area of all triangles that use this vertex.
Receivers vertex_receivers(const Scene& scene);

/// Returns the indices of receivers with an area greater than 0 and a normal that is not zero, in ascending
/// order. A bake traces rays only from these receivers. Other receivers take the transfer of a receiver at
/// the same position if they have a normal, otherwise they stay dark.
std::vector<std::uint32_t> receivers_on_surfaces(const Receivers& receivers);

/// Returns the direct transfer of all vertices as if nothing cast shadows: the clamped-cosine lobe of each
/// normal with `order` (1..kMaxOrder) bands, one term with one channel. It is zero for vertices with a zero
/// normal.
Transfer unshadowed_transfer(const Scene& scene, int order);

} // namespace prt

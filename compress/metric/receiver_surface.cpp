// Collects receiver data from a scene.
#include "prt/compress/receiver_surface.h"

#include "runtime/load/mesh_edges.h"

namespace prt {

SceneSurface::SceneSurface(const Scene& scene) : areas(receiver_areas(scene)), edges(mesh_edges(scene)) {
    normals.reserve(scene.receivers());
    positions.reserve(scene.receivers());
    for (const VertexArray& vertices : scene.vertex_arrays) {
        normals.insert(normals.end(), vertices.normals.begin(), vertices.normals.end());
        positions.insert(positions.end(), vertices.positions.begin(), vertices.positions.end());
    }
}

} // namespace prt

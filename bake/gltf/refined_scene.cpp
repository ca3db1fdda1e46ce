// Applies a refinement to a scene in memory.
#include "prt/gltf/refinement.h"

#include "runtime/load/triangle_normal.h"

namespace prt {
namespace {

template <class T>
void append_means(std::vector<T>& values, const std::vector<Midpoint>& midpoints) {
    if (values.empty())
        return;
    values.reserve(values.size() + midpoints.size());
    for (const Midpoint& m : midpoints)
        values.push_back(0.5f * (values[m.first] + values[m.second]));
}

void append_normals(std::vector<glm::vec3>& normals, const std::vector<Midpoint>& midpoints) {
    normals.reserve(normals.size() + midpoints.size());
    for (const Midpoint& m : midpoints) {
        const glm::vec3 mean = unit_or_zero(glm::dvec3(normals[m.first]) + glm::dvec3(normals[m.second]));
        normals.push_back(mean == glm::vec3(0) ? normals[m.first] : mean);
    }
}

} // namespace

std::size_t Refinement::vertices() const {
    std::size_t sum = 0;
    for (const auto& of_array : midpoints)
        sum += of_array.size();
    return sum;
}

Refinement no_refinement(const Scene& scene) {
    Refinement none;
    none.midpoints.resize(scene.vertex_arrays.size());
    for (const Primitive& primitive : scene.primitives)
        none.triangles.push_back(primitive.triangles);
    return none;
}

Scene refined(const Scene& scene, const Refinement& refinement) {
    Scene finer = scene;
    std::size_t first = 0;
    for (std::size_t a = 0; a < finer.vertex_arrays.size(); ++a) {
        VertexArray& vertices = finer.vertex_arrays[a];
        const std::vector<Midpoint>& midpoints = refinement.midpoints[a];
        append_means(vertices.positions, midpoints);
        append_normals(vertices.normals, midpoints);
        for (std::vector<glm::vec2>& set : vertices.texcoords)
            append_means(set, midpoints);
        append_means(vertices.colors, midpoints);
        if (!midpoints.empty())
            vertices.source.clear(); // the file has no vertices for midpoints
        vertices.first_receiver = first;
        first += vertices.size();
    }
    for (std::size_t p = 0; p < finer.primitives.size(); ++p)
        finer.primitives[p].triangles = refinement.triangles[p];
    return finer;
}

} // namespace prt

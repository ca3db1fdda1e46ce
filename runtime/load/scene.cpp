// Properties of a scene: areas, bounds and the hash of its receivers.
#include "prt/load/scene.h"

#include "runtime/load/triangle_normal.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <bit>
#include <cstdio>

namespace prt {

std::size_t Scene::receivers() const {
    std::size_t count = 0;
    for (const VertexArray& vertices : vertex_arrays)
        count += vertices.size();
    return count;
}

std::size_t Scene::triangles() const {
    std::size_t count = 0;
    for (const Primitive& primitive : primitives)
        count += primitive.triangles.size();
    return count;
}

std::string lamp_name(const Scene& scene, std::size_t material) {
    const std::string& name = scene.materials[material].name;
    return name.empty() ? "material " + std::to_string(material) : name;
}

std::vector<float> receiver_areas(const Scene& scene) {
    std::vector<double> areas(scene.receivers(), 0);
    for (const Primitive& primitive : scene.primitives) {
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        for (const glm::uvec3& t : primitive.triangles) {
            const double area =
                0.5 * glm::length(area_normal(vertices.positions[t.x], vertices.positions[t.y],
                                              vertices.positions[t.z]));
            for (int corner = 0; corner < 3; ++corner)
                areas[vertices.first_receiver + t[corner]] += area / 3;
        }
    }
    return {areas.begin(), areas.end()};
}

std::string receivers_id(const Scene& scene) {
    std::uint64_t sum = 0; // a sum, so that the order of the vertices does not matter
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            std::uint64_t hash = 0xcbf29ce484222325; // FNV-1a, 64 bits, a word at a time
            const auto add = [&](float value) {
                hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x100000001b3;
            };
            for (int axis = 0; axis < 3; ++axis) {
                add(vertices.positions[i][axis]);
                add(vertices.normals[i][axis]);
            }
            // Low bits of a product depend on low bits only; without this step, sums of similar hashes would
            // be similar.
            hash = (hash ^ hash >> 32) * 0xd6e8feb86659fd93;
            sum += hash ^ hash >> 32;
        }
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sum));
    return text;
}

Bounds bounds(const Scene& scene, const Primitive& primitive) {
    Bounds box{glm::vec3(std::numeric_limits<float>::infinity()),
               glm::vec3(-std::numeric_limits<float>::infinity())};
    const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
    for (const glm::uvec3& t : primitive.triangles)
        for (int corner = 0; corner < 3; ++corner) {
            box.low = glm::min(box.low, vertices.positions[t[corner]]);
            box.high = glm::max(box.high, vertices.positions[t[corner]]);
        }
    return box;
}

Bounds bounds(const Scene& scene) {
    Bounds all{glm::vec3(std::numeric_limits<float>::infinity()),
               glm::vec3(-std::numeric_limits<float>::infinity())};
    for (const Primitive& primitive : scene.primitives) {
        const Bounds box = bounds(scene, primitive);
        all = {glm::min(all.low, box.low), glm::max(all.high, box.high)};
    }
    return all;
}

} // namespace prt

// Copies some primitives of a scene.

#include "bake/scene/scene_part.h"

#include <map>

namespace prt {

ScenePart scene_part(const Scene& scene, std::span<const std::size_t> primitives) {
    ScenePart part;
    part.scene.origin = scene.origin;
    part.scene.materials = scene.materials;
    part.scene.lights = scene.lights;
    std::map<std::size_t, std::size_t> arrays;
    for (const std::size_t p : primitives) {
        Primitive primitive = scene.primitives[p];
        const auto [array, is_new] = arrays.try_emplace(primitive.vertices, part.scene.vertex_arrays.size());
        if (is_new) {
            const VertexArray& from = scene.vertex_arrays[primitive.vertices];
            VertexArray& vertices = part.scene.vertex_arrays.emplace_back(from);
            vertices.first_receiver = part.receivers.size();
            for (std::size_t v = 0; v < from.size(); ++v)
                part.receivers.push_back(static_cast<std::uint32_t>(from.first_receiver + v));
        }
        primitive.vertices = array->second;
        part.scene.primitives.push_back(std::move(primitive));
    }
    return part;
}

} // namespace prt

// Writes colors and other vertex attributes into glTF files.

#include "prt/gltf/gltf.h"

#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/write_set.h"

#include <algorithm>

namespace prt {
namespace {

constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};

/// Adds an attribute for the vertices of one array.
std::size_t add_attribute(GltfContents& contents, const VertexArray& vertices,
                          const VertexAttribute& attribute) {
    const auto width = static_cast<std::size_t>(attribute.components);
    const auto own =
        std::span(attribute.values).subspan(vertices.first_receiver * width, vertices.size() * width);
    const std::size_t view = contents.add_buffer_view(std::as_bytes(own), width * sizeof(float), true);
    return contents.add_accessor({{"bufferView", view},
                                  {"componentType", kFloat},
                                  {"count", vertices.size()},
                                  {"type", kTypes[width - 1]}});
}

} // namespace

void write_vertex_attributes(GltfDocument& document, const Scene& scene,
                             std::span<const VertexAttribute> attributes) {
    named(document, [&](GltfContents& contents) {
        const std::vector<Json*> primitives = make_meshes_unique(contents, scene);
        for (const VertexAttribute& attribute : attributes) {
            std::vector<std::size_t> accessors;
            for (const VertexArray& vertices : scene.vertex_arrays)
                accessors.push_back(add_attribute(contents, vertices, attribute));
            for (std::size_t i = 0; i < primitives.size(); ++i)
                (*primitives[i])["attributes"][attribute.name] = accessors[scene.primitives[i].vertices];
        }
    });
}

VertexAttribute shaded_vertex_colors(const Scene& scene, std::span<const float> factors) {
    const bool colored =
        std::ranges::any_of(scene.vertex_arrays, [](const VertexArray& v) { return !v.colors.empty(); });
    VertexAttribute attribute{"COLOR_0", colored ? 4 : 3, {}};
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            const glm::vec4 color = vertices.colors.empty() ? glm::vec4(1) : vertices.colors[v];
            const float factor = factors[vertices.first_receiver + v];
            attribute.values.insert(attribute.values.end(),
                                    {factor * color.r, factor * color.g, factor * color.b});
            if (colored)
                attribute.values.push_back(color.a);
        }
    return attribute;
}

void write_vertex_colors(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> colors) {
    VertexAttribute attribute{"COLOR_0", 3, {}};
    for (const glm::vec3& color : colors)
        attribute.values.insert(attribute.values.end(), {color.r, color.g, color.b});
    write_vertex_attributes(document, scene, std::span(&attribute, 1));
}

} // namespace prt

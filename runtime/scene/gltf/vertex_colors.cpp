// Colors and other attributes of vertices in glTF files.

#include "prt/gltf.h"

#include "gltf/transfer_json.h"
#include "gltf/unshare.h"

namespace prt {
namespace {

constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};

std::size_t add_floats(GltfContents& contents, std::span<const float> values, std::size_t components) {
    const std::size_t view =
        contents.add_buffer_view(std::as_bytes(values), components * sizeof(float), true);
    return contents.add_accessor({{"bufferView", view},
                                  {"componentType", TINYGLTF_COMPONENT_TYPE_FLOAT},
                                  {"count", values.size() / components},
                                  {"type", kTypes[components - 1]}});
}

/// `add(contents, vertices)` gives the accessor of a vertex array.
template <class Add>
void write_attribute(GltfDocument& document, const Scene& scene, const std::string& name, const Add& add) {
    named(document, [&](GltfContents& contents) {
        const std::vector<Json*> primitives = unshare(contents, scene);
        std::vector<std::size_t> accessors;
        for (const VertexArray& vertices : scene.vertex_arrays)
            accessors.push_back(add(contents, vertices));
        for (std::size_t i = 0; i < primitives.size(); ++i)
            (*primitives[i])["attributes"][name] = accessors[scene.primitives[i].vertices];
    });
}

} // namespace

void write_vertex_attribute(GltfDocument& document, const Scene& scene, const std::string& name,
                            std::span<const float> values, int components) {
    const auto width = static_cast<std::size_t>(components);
    write_attribute(document, scene, name, [&](GltfContents& contents, const VertexArray& vertices) {
        return add_floats(contents, values.subspan(vertices.first_receiver * width, vertices.size() * width),
                          width);
    });
}

void write_vertex_colors(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> colors) {
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    write_vertex_attribute(document, scene, "COLOR_0",
                           {reinterpret_cast<const float*>(colors.data()), 3 * colors.size()}, 3);
}

void shade_vertex_colors(GltfDocument& document, const Scene& scene, std::span<const float> factors) {
    write_attribute(document, scene, "COLOR_0", [&](GltfContents& contents, const VertexArray& vertices) {
        const std::span<const float> own = factors.subspan(vertices.first_receiver, vertices.size());
        const std::size_t width = vertices.colors.empty() ? 3 : 4;
        std::vector<float> values;
        values.reserve(width * own.size());
        for (std::size_t v = 0; v < own.size(); ++v) {
            const glm::vec4 color = vertices.colors.empty() ? glm::vec4(1) : vertices.colors[v];
            values.insert(values.end(), {own[v] * color.r, own[v] * color.g, own[v] * color.b});
            if (width == 4)
                values.push_back(color.a);
        }
        return add_floats(contents, values, width);
    });
}

} // namespace prt

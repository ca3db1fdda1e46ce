// Colors of vertices in glTF files.

#include "prt/gltf.h"

#include "gltf/transfer_json.h"
#include "gltf/unshare.h"

namespace prt {

void write_vertex_colors(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> colors) {
    named(document, [&](GltfContents& contents) {
        const std::vector<Json*> primitives = unshare(contents, scene);
        std::vector<std::size_t> accessors;
        for (const VertexArray& vertices : scene.vertex_arrays) {
            const auto own = colors.subspan(vertices.first_receiver, vertices.size());
            const std::size_t view = contents.add_buffer_view(std::as_bytes(own), sizeof(glm::vec3), true);
            accessors.push_back(contents.add_accessor({{"bufferView", view},
                                                       {"componentType", TINYGLTF_COMPONENT_TYPE_FLOAT},
                                                       {"count", own.size()},
                                                       {"type", "VEC3"}}));
        }
        for (std::size_t i = 0; i < primitives.size(); ++i)
            (*primitives[i])["attributes"]["COLOR_0"] = accessors[scene.primitives[i].vertices];
    });
}

} // namespace prt

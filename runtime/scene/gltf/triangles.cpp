// Reads triangles from lists, strips and fans.
#include "runtime/scene/gltf/triangles.h"

#include "prt/core/error.h"
#include "runtime/scene/gltf/accessor.h"
#include "runtime/support/counted.h"

#include <numeric>
#include <string>

namespace prt {

bool is_triangle_mode(int mode) {
    return mode == -1 || mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

std::vector<glm::uvec3> read_triangles(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                       std::size_t vertices) {
    std::vector<std::uint32_t> indices;
    if (primitive.indices >= 0) {
        indices = read_unsigned(model, primitive.indices, 1);
    } else {
        indices.resize(vertices);
        std::iota(indices.begin(), indices.end(), 0u);
    }
    for (const std::uint32_t index : indices)
        if (index >= vertices)
            throw Error("index " + std::to_string(index) + " is out of range: there are " +
                        counted(vertices, "vertex", "vertices"));

    std::vector<glm::uvec3> triangles;
    const bool listed =
        primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP && primitive.mode != TINYGLTF_MODE_TRIANGLE_FAN;
    triangles.reserve(listed ? indices.size() / 3 : indices.size());
    if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (std::size_t i = 0; i + 2 < indices.size(); ++i)
            triangles.emplace_back(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
    } else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        for (std::size_t i = 1; i + 1 < indices.size(); ++i)
            triangles.emplace_back(indices[i], indices[i + 1], indices[0]);
    } else {
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
            triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
    }
    return triangles;
}

} // namespace prt

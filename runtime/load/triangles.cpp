// Reads triangles from lists, strips and fans.
#include "runtime/load/triangles.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/accessor.h"

#include <numeric>
#include <span>
#include <string>

namespace prt {
namespace {

void check_indices(std::span<const std::uint32_t> indices, std::size_t vertices) {
    for (const std::uint32_t index : indices)
        if (index >= vertices)
            throw Error("index " + std::to_string(index) + " is out of range: there are " +
                        counted(vertices, "vertex", "vertices"));
}

} // namespace

bool is_triangle_mode(int mode) {
    return mode == kTriangles || mode == kTriangleStrip || mode == kTriangleFan;
}

std::vector<glm::uvec3> read_triangles(const GltfModel& model, const GltfPrimitive& primitive,
                                       std::size_t vertices) {
    const bool listed = primitive.mode != kTriangleStrip && primitive.mode != kTriangleFan;
    if (listed && primitive.indices >= 0)
        if (const auto plain = integers_in_place(model, primitive.indices, 1); !plain.empty()) {
            check_indices(plain, vertices);
            const auto* first = reinterpret_cast<const glm::uvec3*>(plain.data());
            return {first, first + plain.size() / 3};
        }
    std::vector<std::uint32_t> indices;
    if (primitive.indices >= 0) {
        indices = read_unsigned(model, primitive.indices, 1);
    } else {
        indices.resize(vertices);
        std::iota(indices.begin(), indices.end(), 0u);
    }
    check_indices(indices, vertices);

    std::vector<glm::uvec3> triangles;
    triangles.reserve(listed ? indices.size() / 3 : indices.size());
    if (primitive.mode == kTriangleStrip) {
        for (std::size_t i = 0; i + 2 < indices.size(); ++i)
            triangles.emplace_back(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
    } else if (primitive.mode == kTriangleFan) {
        for (std::size_t i = 1; i + 1 < indices.size(); ++i)
            triangles.emplace_back(indices[i], indices[i + 1], indices[0]);
    } else {
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
            triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
    }
    return triangles;
}

} // namespace prt

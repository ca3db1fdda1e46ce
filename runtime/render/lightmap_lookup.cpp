// Samples lightmaps at surface points.
#include "runtime/render/lightmap_lookup.h"

#include <algorithm>

namespace prt {
namespace {

glm::vec3 mean(const BilinearTexels& filter, std::span<const glm::vec3> values) {
    glm::vec3 sum(0);
    for (std::size_t i = 0; i < 4; ++i)
        sum += static_cast<float>(filter.weights[i]) * values[filter.texels[i]];
    return sum;
}

/// Returns the bilinear sample at texture coordinates of a map, whose first texel is `first`.
BilinearTexels filter_at(const LightmapSize& map, std::size_t first, const glm::vec2& uv) {
    BilinearTexels filter =
        bilinear_texels(map, static_cast<double>(uv.x) * map.width, static_cast<double>(uv.y) * map.height);
    for (std::uint32_t& texel : filter.texels)
        texel += static_cast<std::uint32_t>(first);
    return filter;
}

} // namespace

LightmapLookup::LightmapLookup(const Scene& scene, const LightmapLayout& layout)
    : scene_(scene), layout_(layout), first_texels_(layout.first_texels()), first_triangles_{0} {
    for (const Primitive& primitive : scene.primitives)
        first_triangles_.push_back(first_triangles_.back() +
                                   static_cast<std::uint32_t>(primitive.triangles.size()));
}

std::size_t LightmapLookup::primitive_of(std::uint32_t triangle) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(first_triangles_, triangle) -
                                    first_triangles_.begin()) -
           1;
}

bool LightmapLookup::has_texels(std::uint32_t triangle) const {
    return layout_.placements[primitive_of(triangle)].map != kNoMap;
}

BilinearTexels LightmapLookup::filter(std::uint32_t triangle, const glm::vec2& barycentrics) const {
    const std::size_t p = primitive_of(triangle);
    const Primitive& primitive = scene_.primitives[p];
    const LightmapPlacement& position = layout_.placements[p];
    const std::vector<glm::vec2>& uv =
        scene_.vertex_arrays[primitive.vertices].texcoords[static_cast<std::size_t>(position.texcoord)];
    const glm::uvec3& t = primitive.triangles[triangle - first_triangles_[p]];
    const glm::vec2 at =
        uv[t.x] * (1 - barycentrics.x - barycentrics.y) + uv[t.y] * barycentrics.x + uv[t.z] * barycentrics.y;
    return filter_at(layout_.maps[position.map], first_texels_[position.map], at);
}

glm::vec3 LightmapLookup::look_up(std::uint32_t triangle, const glm::vec2& barycentrics,
                                  std::span<const glm::vec3> values) const {
    return mean(filter(triangle, barycentrics), values);
}

std::vector<glm::vec3> at_vertices(const Scene& scene, const LightmapLayout& layout,
                                   std::span<const glm::vec3> values) {
    std::vector<glm::vec3> result(scene.receivers());
    const std::vector<std::size_t> first = layout.first_texels();
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const LightmapPlacement& position = layout.placements[p];
        if (position.map == kNoMap)
            continue;
        const VertexArray& vertices = scene.vertex_arrays[scene.primitives[p].vertices];
        const auto& uv = vertices.texcoords[static_cast<std::size_t>(position.texcoord)];
        for (std::size_t v = 0; v < vertices.size(); ++v)
            result[vertices.first_receiver + v] =
                mean(filter_at(layout.maps[position.map], first[position.map], uv[v]), values);
    }
    return result;
}

} // namespace prt

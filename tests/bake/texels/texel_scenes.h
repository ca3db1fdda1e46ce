#pragma once

// Scenes with maps, and their texels.

#include "prt/bake/lightmap_bake.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace prt::test {

/// Two metres of floor that fill a map of `size` texels along a side.
inline Scene floor_map(Scene scene) {
    for (VertexArray& vertices : scene.vertex_arrays) {
        vertices.texcoords.assign(1, {});
        for (const glm::vec3& p : vertices.positions)
            vertices.texcoords[0].emplace_back((p.x + 1) / 2, (p.z + 1) / 2);
    }
    return scene;
}

inline Atlas whole(const Scene& scene, int size) {
    return plan_atlases(scene, {.size = size, .uv_set = 0}).front();
}

/// Returns `scene`, which has a map, and `more`, whose coordinates are one point.
inline Scene beside_map(const Scene& scene, const Scene& more) {
    Scene both = join({scene, more});
    VertexArray& last = both.vertex_arrays.back();
    last.texcoords.assign(1, std::vector<glm::vec2>(last.positions.size(), glm::vec2(0.5f)));
    return both;
}

/// For the second primitive.
inline Atlas of_one_texel() {
    return {.primitives = {1}, .uv_set = 0, .width = 1, .height = 1};
}

inline BakeOptions options_of(int order, int rays, int bounces) {
    BakeOptions options;
    options.order = order;
    options.rays = rays;
    options.bounces = bounces;
    options.tracer.backend = Backend::cpu;
    options.memory.storage = TransferStorage::float32;
    return options;
}

/// Returns a bilinear lookup of the transfer in the first map at `uv`.
inline std::vector<float> lookup(const BakedLightmap& map, const glm::vec2& uv) {
    const LightmapSize& size = map.layout.maps[0];
    const BilinearTexels filter = bilinear_texels(size, static_cast<double>(uv.x) * size.width,
                                                  static_cast<double>(uv.y) * size.height);
    std::vector<float> sum(map.baked.transfer.dimension());
    for (std::size_t k = 0; k < 4; ++k) {
        const auto found = std::ranges::lower_bound(map.texels, filter.texels[k]);
        EXPECT_TRUE(found != map.texels.end() && *found == filter.texels[k]);
        const auto texel = map.baked.transfer.vector(static_cast<std::size_t>(found - map.texels.begin()));
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += static_cast<float>(filter.weights[k]) * texel[i];
    }
    return sum;
}

} // namespace prt::test

// Lightmaps on the GPU against C++, and as surfaces show them.

#include "bake/reference/ray_renderer.h"
#include "prt/gl/gl_context.h"
#include "prt/gl/gl_renderer.h"
#include "prt/render/lightmap_file.h"
#include "runtime/render/lightmap_lookup.h"
#include "support/gl_radiance.h"
#include "support/random_lightmap.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

namespace prt {
namespace {

float largest_difference(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    EXPECT_EQ(a.size(), b.size());
    float largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, glm::distance(a[i], b[i]) / std::max(1.0f, glm::length(a[i])));
    return largest;
}

class LightmapPasses : public testing::TestWithParam<std::tuple<int, bool>> {};
INSTANTIATE_TEST_SUITE_P(Words, LightmapPasses, testing::Combine(testing::Values(1, 2), testing::Bool()));

TEST_P(LightmapPasses, MatchCppInComputeAndFragmentShaders) {
    const auto context = GlContext::create(GlDevice::any);
    ASSERT_TRUE(context);
    std::mt19937 random(4);
    const auto [words, alike] = GetParam();
    const CompressedLightmap lightmap =
        test::random_lightmap({{33, 17}, {8, 8}, {1, 1}}, words, alike, random);
    const Lighting lighting{constant_light(3, glm::vec3(1, 0.5f, 2))};
    const std::vector<glm::vec3> expected = exit_radiance(lightmap.compressed.transfer, lighting);
    EXPECT_LT(largest_difference(expected, test::lightmap_radiance_gl(lightmap, lighting, *context)), 1e-5f);
    EXPECT_LT(
        largest_difference(expected, test::lightmap_radiance_by_fragments(lightmap, lighting, *context)),
        1e-5f);
}

TEST(LightmapPictures, MatchBetweenRaysAndOpenGl) {
    const auto context = GlContext::create(GlDevice::any);
    ASSERT_TRUE(context);
    Scene scene = test::SceneBuilder().floor({0, 0, 0}, 1).build();
    scene.vertex_arrays[0].texcoords.assign(2, {});
    for (const glm::vec3& p : scene.vertex_arrays[0].positions)
        scene.vertex_arrays[0].texcoords[1].emplace_back((p.x + 1) / 2, (p.z + 1) / 2);
    const LightmapLayout layout{{{8, 8}}, {{0, 1}}};
    std::vector<glm::vec3> radiance;
    for (int i = 0; i < 64; ++i)
        radiance.emplace_back(i % 8, i / 8, 1);
    Picture picture;
    picture.scene = &scene;
    picture.in_shader.lightmaps = {.layout = &layout, .radiance = radiance};
    picture.camera = automatic_camera(scene, 1, 0.6f);
    picture.width = picture.height = 64;
    picture.samples = 1;
    const TraceScene traced(scene);
    const Image by_rays = render_rays(picture, traced, {}), by_gl = render_gl(picture, *context);
    double off = 0;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < by_rays.pixels.size(); ++i)
        if (by_rays.pixels[i].b > 0 && by_gl.pixels[i].b > 0) {
            ++seen;
            off += static_cast<double>(glm::distance(by_rays.pixels[i], by_gl.pixels[i]));
        }
    ASSERT_GT(seen, 100u);
    EXPECT_LT(off / static_cast<double>(seen), 0.05); // half floats of up to 7, and eight bits between texels
}

TEST(LightmapLookup, FindsTheTexelsOfAPosition) {
    Scene scene = test::SceneBuilder().floor({0, 0, 0}, 1).build();
    scene.vertex_arrays[0].texcoords.assign(1, {});
    for (const glm::vec3& p : scene.vertex_arrays[0].positions)
        scene.vertex_arrays[0].texcoords[0].emplace_back((p.x + 1) / 2, (p.z + 1) / 2);
    const LightmapLayout layout{{{2, 2}, {16, 16}}, {{1, 0}}}; // in the second map
    std::vector<glm::vec3> values(4, glm::vec3(99));
    for (float y = 0.5f; y < 16; ++y)
        for (float x = 0.5f; x < 16; ++x)
            values.emplace_back(x, y, 0);
    const LightmapLookup lookup(scene, layout);
    const auto& t = scene.primitives[0].triangles[0];
    const auto& uv = scene.vertex_arrays[0].texcoords[0];
    const glm::vec2 position = 16.0f * (uv[t.x] * 0.5f + uv[t.y] * 0.3f + uv[t.z] * 0.2f);
    const glm::vec3 found = lookup.look_up(0, {0.3f, 0.2f}, values);
    EXPECT_NEAR(found.x, position.x, 1e-4f);
    EXPECT_NEAR(found.y, position.y, 1e-4f);
}

} // namespace
} // namespace prt

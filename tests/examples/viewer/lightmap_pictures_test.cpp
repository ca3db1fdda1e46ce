// Tests pictures by lightmaps against those of prt render, and the positions of texels.

#include "core/hovered.h"
#include "core/screen.h"
#include "core/texel_light.h"
#include "core/transfer_work.h"
#include "examples/viewer/lightmap_files.h"
#include "pictures/frame_renderer.h"

#include "bake/reference/ray_renderer.h"
#include "prt/bake/lightmap_bake.h"
#include "prt/gl/gl_context.h"
#include "prt/gl/gl_renderer.h"
#include "prt/render/lightmap_file.h"
#include "runtime/render/lightmap_lookup.h"
#include "support/scene_builder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace viewer {
namespace {

constexpr glm::ivec2 kShot(160, 120);

/// A sky with a separate sun.
struct LitSeparately {
    std::vector<prt::Sun> suns{{glm::normalize(glm::vec3(0.6f, 1, 0.4f)), {3, 2.5f, 2}, 0.01}};
    prt::Lighting lighting{prt::overcast_sky(4, {0.3f, 0.4f, 0.6f}), prt::as_light(suns[0], 4)};
};

class LightmapPictures : public testing::Test {
protected:
    void SetUp() override {
        context = prt::GlContext::create(prt::GlDevice::any);
        ASSERT_TRUE(context);
        renderer = std::make_unique<FrameRenderer>();
        renderer->resize({kShot.x, kShot.y, 1});
        settings.drawing.background = false;
        loaded = load_together({files.raw(), files.shipped()}, {}).first;
        gpu = std::make_unique<GpuModel>(loaded.model);
        gpu->set_raw(loaded.lightmap.baked);
        gpu->set_compressed(loaded.lightmap.compressed);
        gpu->set_lighting(lit.lighting, lit.suns);
        view.camera = prt::automatic_camera(loaded.model->scene, float{kShot.x} / float{kShot.y}, 0.6f);
    }
    void TearDown() override {
        gpu.reset();
        renderer.reset();
    }

    prt::Image drawn(PictureKind kind) {
        renderer->draw(1, kind, *gpu, settings.drawing, view, {0, kShot.x});
        return renderer->read(1);
    }
    /// Moves the camera straight above the floor next to the ball, so close that `pixels` equal a texel, and
    /// rotated relative to texels.
    void look_at_floor(float pixels) {
        const prt::LightmapLayout& layout = *loaded.lightmap.layout();
        ASSERT_EQ(layout.maps.size(), 1u);
        view.camera.target = {1, -0.5f, 1};
        view.camera.position = {1.001f, 1, 1.001f};
        // From a height of 1.5; the floor ends not far from there.
        const float texels_a_pixel = glm::length(texel_at({100, 60}) - texel_at({60, 60})) / 40;
        view.camera.position.y = -0.5f + 1.5f / (texels_a_pixel * pixels);
    }
    std::optional<prt::RayHit> hit_at(const glm::vec2& pixel) const {
        return loaded.model->trace->rays().nearest(
            {view.camera.position, direction_through({view.camera, glm::vec2(kShot)}, pixel)});
    }
    /// Returns the position on the floor in texels from the corner of the map; -1 outside it.
    glm::vec2 texel_at(const glm::vec2& pixel) const {
        const auto hit = hit_at(pixel);
        const glm::vec3 way = direction_through({view.camera, glm::vec2(kShot)}, pixel);
        if (!hit || std::abs(view.camera.position.y + hit->distance * way.y + 0.5f) > 1e-3f)
            return glm::vec2(-1);
        const prt::Scene& scene = loaded.model->scene; // the scene has one primitive
        const auto& uv =
            scene.vertex_arrays[0]
                .texcoords[static_cast<std::size_t>(loaded.lightmap.layout()->placements[0].texcoord)];
        const glm::uvec3& t = scene.primitives[0].triangles[hit->triangle];
        const prt::LightmapSize& map = loaded.lightmap.layout()->maps[0];
        return (uv[t.x] * (1 - hit->uv.x - hit->uv.y) + uv[t.y] * hit->uv.x + uv[t.z] * hit->uv.y) *
               glm::vec2(map.width, map.height);
    }

    /// Returns the radiance of all texels computed in C++, instead of compute shaders.
    std::vector<glm::vec3> radiance(PictureKind kind) const {
        if (kind == PictureKind::prt_compressed)
            return prt::exit_radiance(*loaded.compressed, lit.lighting);
        return prt::scatter_to_maps(*loaded.lightmap.layout(), loaded.lightmap.baked->texels,
                                    prt::exit_radiance(*loaded.raw, lit.lighting));
    }
    prt::Picture picture_by(const std::vector<glm::vec3>& texels) const {
        prt::Picture picture = picture_of(*loaded.model, {}, view.camera, kShot.x, kShot.y);
        picture.textured = settings.drawing.textured;
        picture.in_shader.lightmaps = {.layout = loaded.lightmap.layout(), .radiance = texels};
        picture.suns = lit.suns;
        return picture;
    }

    LightmapFiles files;
    LitSeparately lit;
    std::unique_ptr<prt::GlContext> context;
    std::unique_ptr<FrameRenderer> renderer;
    LoadedModel loaded;
    std::unique_ptr<GpuModel> gpu;
    Settings settings;
    FrameView view;
};

/// Sum of differences over the sum of `b`; half precision is 0.05 %.
double share_of_difference(const prt::Image& a, const prt::Image& b) {
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < b.pixels.size(); ++i) {
        const glm::vec3 d = glm::abs(a.pixels[i] - b.pixels[i]);
        difference += static_cast<double>(d.r + d.g + d.b);
        sum += static_cast<double>(b.pixels[i].r + b.pixels[i].g + b.pixels[i].b);
    }
    EXPECT_GT(sum, 0);
    return difference / sum;
}

TEST_F(LightmapPictures, MatchPrtRender) {
    for (const PictureKind kind : {PictureKind::prt, PictureKind::prt_compressed}) {
        const std::vector<glm::vec3> texels = radiance(kind);
        const prt::Image expected = prt::render_gl(picture_by(texels), *context);
        settings.drawing.deferred = false;
        EXPECT_LT(share_of_difference(drawn(kind), expected), 0.001) << name_of(kind).id;
        settings.drawing.deferred = true; // base colours in 8 bits
        EXPECT_LT(share_of_difference(drawn(kind), expected), 0.004) << name_of(kind).id;
    }
}

TEST_F(LightmapPictures, MatchRaysForTexelsOfPixelSize) {
    look_at_floor(2); // larger ones have no smaller levels, which rays do not know
    settings.drawing.textured = false;
    const std::vector<glm::vec3> texels = radiance(PictureKind::prt_compressed);
    const prt::Image expected = prt::render_rays(picture_by(texels), *loaded.model->trace);
    // Rays and shadow maps differ along the edge of the shadow.
    EXPECT_LT(share_of_difference(drawn(PictureKind::prt_compressed), expected), 0.01);
}

TEST_F(LightmapPictures, FollowChangesOfLight) {
    const prt::Image before = drawn(PictureKind::prt);
    for (glm::vec3& c : lit.lighting.sky.coefficients)
        c *= 2.0f;
    for (glm::vec3& c : lit.lighting.suns->coefficients)
        c *= 2.0f;
    gpu->set_lighting(lit.lighting, {});
    const prt::Image twice = drawn(PictureKind::prt);
    for (glm::vec3& c : lit.lighting.sky.coefficients)
        c *= 0.5f;
    for (glm::vec3& c : lit.lighting.suns->coefficients)
        c *= 0.5f;
    gpu->set_lighting(lit.lighting, {});
    prt::Image once = drawn(PictureKind::prt);
    for (glm::vec3& pixel : once.pixels)
        pixel *= 2.0f;
    EXPECT_LT(share_of_difference(once, twice), 0.002);
    EXPECT_GT(share_of_difference(before, twice), 0.1);
}

TEST_F(LightmapPictures, NumbersShowTheTexelAtEachPixel) {
    look_at_floor(8);
    std::vector<glm::vec3> colors;
    for (std::size_t t = 0; t < loaded.lightmap.layout()->texels();
         ++t) // no two texels side by side have one
        colors.emplace_back(t % 7, t / 64 % 5, t % 3);
    gpu->set_numbers(PictureKind::clusters, colors);
    const prt::Image picture = drawn(PictureKind::clusters);
    std::size_t compared = 0;
    for (int y = 0; y < kShot.y; ++y)
        for (int x = 0; x < kShot.x; ++x) {
            const glm::vec2 texel = texel_at(glm::vec2(x, y) + 0.5f);
            const glm::vec2 inside = glm::fract(texel);
            if (texel.x < 0 || glm::any(glm::lessThan(glm::min(inside, 1.0f - inside), glm::vec2(0.02f))))
                continue;
            ++compared;
            ASSERT_EQ(picture.at(x, y),
                      colors[static_cast<std::size_t>(texel.y) * 64 + static_cast<std::size_t>(texel.x)]);
        }
    EXPECT_GT(compared, std::size_t{kShot.x} * kShot.y / 2);
}

/// Returns the pixels where two pictures differ by more than `least`.
std::set<std::pair<int, int>> changed_pixels(const prt::Image& a, const prt::Image& b, float least) {
    std::set<std::pair<int, int>> changed;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const glm::vec3 d = glm::abs(a.at(x, y) - b.at(x, y));
            if (std::max({d.r, d.g, d.b}) > least)
                changed.emplace(x, y);
        }
    return changed;
}

TEST_F(LightmapPictures, HaveAGridAtTheBordersOfTexels) {
    for (const float texel_pixels : {10.0f, 16.0f})
        for (const int samples : {1, 2}) {
            look_at_floor(texel_pixels);
            renderer->resize({kShot.x, kShot.y, samples});
            const prt::Image plain = drawn(PictureKind::prt);
            renderer->draw_texel_grid(1, PictureKind::prt, *gpu, settings.drawing, view, {0, kShot.x});
            const auto lines = changed_pixels(renderer->read(1), plain, 1e-3f);
            const auto scale = static_cast<float>(samples);
            for (int y = 0; y < kShot.y * samples; ++y)
                for (int x = 0; x < kShot.x * samples; ++x) {
                    const glm::vec2 texel = texel_at((glm::vec2(x, y) + 0.5f) / scale);
                    if (texel.x < 0)
                        continue;
                    const glm::vec2 to_border = glm::min(glm::fract(texel), 1.0f - glm::fract(texel));
                    // In samples. A line covers half a pixel on either side, and fades within a sample.
                    const float distance = std::min(to_border.x, to_border.y) * texel_pixels * scale;
                    if (lines.contains({x, y}))
                        ASSERT_LT(distance, 0.5f * scale + 0.7f) << x << " " << y;
                    else
                        ASSERT_GT(distance, 0.4f * scale) << x << " " << y;
                }
            EXPECT_GT(lines.size(), std::size_t{kShot.x} * kShot.y / 20);
        }
}

TEST_F(LightmapPictures, HaveNoGridForSmallTexels) {
    const auto changed = [&](float texel_pixels) {
        look_at_floor(texel_pixels);
        const prt::Image plain = drawn(PictureKind::unshadowed);
        renderer->draw_texel_grid(1, PictureKind::unshadowed, *gpu, settings.drawing, view, {0, kShot.x});
        const prt::Image grid = renderer->read(1);
        double sum = 0;
        for (std::size_t i = 0; i < plain.pixels.size(); ++i)
            sum += static_cast<double>(glm::distance(plain.pixels[i], grid.pixels[i]));
        return sum;
    };
    const double none = changed(2.2f), faint = changed(5), whole = changed(9);
    // The floor is the nearest surface except at the ball, where derivatives of a pixel at an edge come from
    // another triangle.
    EXPECT_LT(none, 1e-4 * whole);
    EXPECT_GT(faint, 0.01 * whole);
    EXPECT_LT(faint, whole); // though there are more lines
}

TEST_F(LightmapPictures, KeepDepthUnderTheGrid) {
    look_at_floor(10);
    std::vector<float> before, after;
    renderer->draw(1, PictureKind::prt, *gpu, settings.drawing, view, {0, kShot.x});
    renderer->read(1, &before);
    renderer->draw_texel_grid(1, PictureKind::prt, *gpu, settings.drawing, view, {0, kShot.x});
    renderer->read(1, &after);
    EXPECT_EQ(before, after);
}

TEST_F(LightmapPictures, AreMeteredByTheirTexels) {
    std::vector<std::uint32_t> texels;
    for (std::uint32_t t = 0; t < loaded.lightmap.layout()->texels(); t += 3)
        if (receiver_of(loaded.lightmap.baked->texels, t)) // elsewhere the raw one is black
            texels.push_back(t);
    for (const PictureKind kind : {PictureKind::prt, PictureKind::prt_compressed}) {
        LoadedModel only = loaded;
        if (kind == PictureKind::prt)
            only.compressed = nullptr;
        const std::vector<glm::vec3> expected = radiance(kind);
        const std::vector<glm::vec3> metered = texel_radiance(only, lit.lighting, texels);
        ASSERT_EQ(metered.size(), texels.size());
        for (std::size_t i = 0; i < texels.size(); ++i)
            EXPECT_LT(glm::distance(metered[i], expected[texels[i]]), 1e-5f);
    }
}

TEST_F(LightmapPictures, HaveLobesOfTheTexelUnderThePointer) {
    look_at_floor(8);
    const glm::vec2 pixel(40.5f, 70.5f), texel = texel_at(pixel);
    const auto found = find_hovered(loaded, true, {view.camera, glm::vec2(kShot)}, pixel);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->of, Receivers::texels);
    EXPECT_EQ(found->receiver,
              static_cast<std::uint32_t>(texel.y) * 64 + static_cast<std::uint32_t>(texel.x));
    EXPECT_NEAR(found->position.y, -0.5f, 1e-4f);
    const auto receiver = receiver_of(loaded.lightmap.baked->texels, found->receiver);
    ASSERT_TRUE(receiver);
    const std::vector<float> whole = prt::as_combined(loaded.raw->vector(*receiver), loaded.raw->layout);
    ASSERT_EQ(found->vector.size(), 16u);
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_EQ(found->vector[i], whole[i]);
    EXPECT_EQ(found->cluster, loaded.compressed->receivers.cluster(found->receiver));
}

TEST_F(LightmapPictures, ErrorsAreBrightestAtTheWorstTexel) {
    const auto pictures = number_pictures(loaded, lit.lighting, {});
    ASSERT_EQ(pictures.size(), 4u);
    for (const auto& [kind, colors] : pictures)
        EXPECT_EQ(colors.size(), loaded.lightmap.layout()->texels()) << name_of(kind).id;
    // The error of a texel, by the transfer of that texel alone.
    const std::vector<glm::vec3> raw = radiance(PictureKind::prt),
                                 small = radiance(PictureKind::prt_compressed);
    const std::vector<std::uint32_t>& texels = loaded.lightmap.baked->texels;
    const auto error = [&](std::uint32_t texel) {
        const glm::vec3 d = glm::abs(raw[texel] - small[texel]);
        return std::max({d.r, d.g, d.b});
    };
    const auto [least, most] = std::ranges::minmax(texels, {}, error);
    const std::vector<glm::vec3>& errors = pictures[2].second;
    ASSERT_EQ(pictures[2].first, PictureKind::error);
    EXPECT_LT(glm::length(errors[least]), glm::length(errors[most]));
}

/// Returns a floor that fills a map, emits some light, and has a lamp over it.
prt::Scene floor_with_lamp() {
    prt::Scene scene =
        prt::test::painted(prt::test::SceneBuilder().floor({0, 0, 0}, 1, 4).build(), {0.7f, 0.5f, 0.3f});
    prt::VertexArray& vertices = scene.vertex_arrays[0];
    vertices.texcoords.assign(1, {});
    for (const glm::vec3& p : vertices.positions)
        vertices.texcoords[0].emplace_back(0.5f * (glm::vec2(p.x, p.z) + 1.0f));
    scene.lights.push_back({.name = "warm", .intensity = {2, 1.5f, 1}, .position = {0.4f, 0.8f, 0.2f}});
    scene.materials[0].name = "glow";
    scene.materials[0].emission.radiance = {0.05f, 0.1f, 0.2f};
    return scene;
}

TEST_F(LightmapPictures, ShowLampsAndEmission) {
    loaded = {};
    loaded.model = make_model(floor_with_lamp(), "test");
    const prt::Scene& scene = loaded.model->scene;
    prt::BakeOptions options;
    options.order = 4;
    options.rays = 32;
    options.tracer.backend = prt::Backend::cpu;
    loaded.set(std::make_shared<const prt::BakedLightmap>(
        prt::bake_lightmap(scene, prt::plan_atlases(scene, {.size = 16, .uv_set = 0}), options).lightmap));
    const Compressed small = [&] {
        BackgroundWork<Finding> work;
        Compressed result;
        work.start([&](Channel& channel) { result = compress_as(channel, loaded, {.order = 4}); });
        while (work.busy())
            work.collect();
        return result;
    }();
    loaded.set(small.lightmap);
    view.camera = prt::automatic_camera(scene, float{kShot.x} / float{kShot.y}, 0.6f);
    gpu = std::make_unique<GpuModel>(loaded.model);
    gpu->set_raw(loaded.lightmap.baked);
    gpu->set_compressed(loaded.lightmap.compressed);
    const LampSettings lamps{.strength = 2, .each = {{.name = "warm", .color = {1, 0.5f, 0.25f}}}};
    gpu->set_lighting({lit.lighting.sky}, {}, lamps);

    const prt::TransferLayout& layout = loaded.raw->layout;
    const std::vector<glm::vec3> strengths = strengths_of(lamps, layout);
    const std::vector<glm::vec3> emission = prt::emission_strengths(scene, layout, strengths);
    ASSERT_EQ(strengths.size(), 2u); // the lamp, and the emissive floor
    lit.suns.clear();
    lit.lighting = {lit.lighting.sky, {}, strengths};
    for (const PictureKind kind : {PictureKind::prt, PictureKind::prt_compressed}) {
        const std::vector<glm::vec3> texels = radiance(kind);
        prt::Picture picture = picture_by(texels);
        picture.emission = emission;
        EXPECT_LT(share_of_difference(drawn(kind), prt::render_gl(picture, *context)), 0.002)
            << name_of(kind).id;
    }
}

} // namespace
} // namespace viewer

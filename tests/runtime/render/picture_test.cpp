// The picture of OpenGL against that of rays.

#include "bake/reference/light_meter.h"
#include "bake/reference/ray_renderer.h"
#include "prt/bake/bake.h"
#include "prt/compress/compress.h"
#include "prt/core/error.h"
#include "prt/gl/gl_renderer.h"
#include "prt/render/tone_map.h"
#include "runtime/load/predictors.h"
#include "support/predicted.h"
#include "support/scene_builder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace prt {
namespace {

constexpr int kWidth = 160, kHeight = 120;

/// A sphere on a floor, which has a texture with its second half cut out, and a pane in front.
struct TestScene {
    Scene scene;
    std::vector<Texture> textures;

    TestScene() {
        scene = test::SceneBuilder().floor({0, -0.5f, 0}, 1.5f, 8).sphere({0, 0, 0}, 0.5f, 24).build();
        Primitive& all = scene.primitives[0];
        VertexArray& vertices = scene.vertex_arrays[0];
        vertices.texcoords.emplace_back();
        for (const glm::vec3& p : vertices.positions)
            vertices.texcoords[0].emplace_back(p.x, p.z);
        Image8 checker{16, 16, {}};
        for (int i = 0; i < 256; ++i)
            checker.pixels.emplace_back((i / 4 + i / 64) % 2 ? 250 : 40, 120, i, i % 16 < 3 ? 0 : 255);
        textures.push_back(make_texture(checker));
        scene.materials.resize(3);
        scene.materials[1].base_color_texture.image = 0;
        scene.materials[1].alpha_mode = AlphaMode::mask;
        scene.materials[1].double_sided = true;
        scene.materials[2].base_color = {0.9f, 0.3f, 0.2f, 0.4f};
        scene.materials[2].alpha_mode = AlphaMode::blend;

        const std::size_t floor_triangles = 2 * 8 * 8;
        Primitive floor = all;
        floor.material = 1;
        floor.triangles.assign(all.triangles.begin(), all.triangles.begin() + floor_triangles);
        all.triangles.erase(all.triangles.begin(), all.triangles.begin() + floor_triangles);
        Primitive pane = floor;
        pane.material = 2;
        const auto first = static_cast<std::uint32_t>(vertices.size());
        for (const glm::vec2 corner : {glm::vec2(-0.3f, -0.4f), {0.8f, -0.4f}, {0.8f, 0.3f}, {-0.3f, 0.3f}}) {
            vertices.positions.emplace_back(corner, 0.9f);
            vertices.normals.emplace_back(0, 0, 1);
            vertices.texcoords[0].push_back(corner);
        }
        pane.triangles = {{first, first + 1, first + 2}, {first, first + 2, first + 3}};
        scene.primitives.push_back(floor);
        scene.primitives.push_back(pane);
    }
};

/// True if a pixel or a neighbour is at an edge of the picture's content.
bool near_edge(const Image& image, int x, int y) {
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const int nx = std::clamp(x + dx, 0, image.width - 1),
                      ny = std::clamp(y + dy, 0, image.height - 1);
            if (glm::distance(image.at(nx, ny), image.at(x, y)) > 0.25f)
                return true;
        }
    return false;
}

struct Difference {
    double mean = 0, compared = 0;
};

/// Mean absolute difference of display values in 255ths, away from edges.
Difference difference(const Image& a, const Image& b) {
    const auto pa = tone_mapped(a, 1, 1, ToneMap::srgb), pb = tone_mapped(b, 1, 1, ToneMap::srgb);
    Difference d;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            if (near_edge(a, x, y))
                continue;
            const auto i = static_cast<std::size_t>(y * a.width + x);
            for (int c = 0; c < 3; ++c)
                d.mean += std::abs(static_cast<double>(pa[i][c]) - static_cast<double>(pb[i][c])) / 3;
            d.compared += 1;
        }
    d.mean /= d.compared;
    d.compared /= static_cast<double>(a.width * a.height);
    return d;
}

class Pictures : public testing::Test {
protected:
    void SetUp() override {
        std::string why;
        context = GlContext::create(GlDevice::any, &why);
        ASSERT_TRUE(context) << why;
        picture.scene = &objects.scene;
        picture.textures = objects.textures;
        picture.width = kWidth;
        picture.height = kHeight;
        picture.samples = 1;
        picture.camera = automatic_camera(objects.scene, float{kWidth} / float{kHeight}, 0.7f);
        background = {64, 32, {}};
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x)
                background.pixels.emplace_back(static_cast<float>(x) / 64, static_cast<float>(y) / 32, 0.3f);
        picture.background.image = &background;
        picture.background.rotation = 0.6f;
    }

    TestScene objects;
    Image background;
    Picture picture;
    std::unique_ptr<GlContext> context;
};

TEST_F(Pictures, CompressedTransferMatches) {
    BakeOptions bake_options;
    bake_options.rays = 64;
    bake_options.repairs.bad_textures =
        BadTextures::ignore; // the image of one of the scene's textures is missing
    const Transfer transfer = bake(objects.scene, bake_options).baked.transfer;
    CompressOptions options;
    options.clusters = 8;
    options.coding.components = 6;
    ClusteredTransfer compressed = compress(transfer, {receiver_areas(objects.scene)}, options).transfer;
    std::mt19937 random(4);
    test::add_predictors(compressed.bases, {PredictorKind::normal, PredictorKind::position}, random);
    compressed.receivers.predictors = predictor_coordinates(objects.scene, compressed.bases.predictors);
    const Light light = overcast_sky(6, glm::vec3(1, 0.9f, 0.8f));
    const auto radiance = exit_radiance(compressed, light);
    picture.radiance = radiance;
    const Image rays = render_rays(picture, TraceScene(objects.scene));
    const Lighting lighting{light};
    picture.in_shader = {&compressed, &lighting};
    const Image gl = render_gl(picture, *context);
    const Difference d = difference(rays, gl);
    RecordProperty("mean_absolute_difference_255ths", std::to_string(d.mean));
    EXPECT_LT(d.mean, 1.0);
    EXPECT_GT(d.compared, 0.6); // most of the picture was compared
}

TEST_F(Pictures, ColorsMatch) {
    std::vector<glm::vec3> colors;
    for (const glm::vec3& p : objects.scene.vertex_arrays[0].positions)
        colors.push_back(0.5f + 0.4f * glm::sin(p * 3.0f));
    picture.radiance = colors;
    picture.textured = false;
    picture.background.image = nullptr;
    const Difference d =
        difference(render_rays(picture, TraceScene(objects.scene)), render_gl(picture, *context));
    EXPECT_LT(d.mean, 0.2);
    EXPECT_GT(d.compared, 0.6);
}

TEST_F(Pictures, ShowTheSceneUprightAndTheRightWayRound) {
    objects.scene.primitives.pop_back(); // the pane would hide the sphere
    std::vector<glm::vec3> colors;       // right of the middle red, above it green
    for (const glm::vec3& p : objects.scene.vertex_arrays[0].positions)
        colors.emplace_back(p.x > 0, p.y > 0, 0);
    picture.radiance = colors;
    picture.textured = false;
    picture.background.image = nullptr;
    picture.camera = {{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.5f};
    for (const Image& image : {render_rays(picture, TraceScene(objects.scene)), render_gl(picture, *context)})
        for (const int x : {-15, 15})
            for (const int y : {-15, 15}) { // the sphere's radius is some 30 pixels
                const glm::vec3 pixel = image.at(kWidth / 2 + x, kHeight / 2 + y);
                EXPECT_NEAR(pixel.r, x > 0 ? 1 : 0, 0.1f);
                EXPECT_NEAR(pixel.g, y < 0 ? 1 : 0, 0.1f);
            }
}

TEST_F(Pictures, ShowTheBackgroundInTheViewDirection) {
    const std::vector<glm::vec3> black(objects.scene.receivers(), glm::vec3(0));
    picture.radiance = black;
    picture.background.rotation = 0;
    picture.camera = {{0, 0, 30}, {0, 0, 60}, {0, 1, 0}, 0.5f}; // along +Z: the center of the lat-long
    for (const Image& image :
         {render_rays(picture, TraceScene(objects.scene)), render_gl(picture, *context)}) {
        EXPECT_NEAR(image.at(kWidth / 2, kHeight / 2).r, 0.5f, 0.02f);
        EXPECT_NEAR(image.at(kWidth / 2, kHeight / 2).g, 0.5f, 0.02f);
        EXPECT_LT(image.at(kWidth / 2, 2).g, image.at(kWidth / 2, kHeight - 3).g); // top row of the map is up
        EXPECT_LT(image.at(2, kHeight / 2).r, image.at(kWidth - 3, kHeight / 2).r); // its left is the left
        for (int y = 1; y < kHeight; ++y)                                           // row by row
            EXPECT_LE(image.at(kWidth / 2, y - 1).g, image.at(kWidth / 2, y).g + 1e-4f) << y;
    }
}

/// Returns a one-sided square sheet that faces +Z or -Z, as `sign`.
Scene sheet(float sign) {
    return test::painted(
        test::SceneBuilder().quad({-sign, -1, 0}, {sign, -1, 0}, {sign, 1, 0}, {-sign, 1, 0}).build(),
        glm::vec3(1));
}

TEST(RayRenderer, CoincidentSheetsShowTheFacingSheet) {
    for (const Scene& scene : {test::join({sheet(1), sheet(-1)}), test::join({sheet(-1), sheet(1)}),
                               test::with_opposites(sheet(1))}) {
        std::vector<glm::vec3> colors; // red for the sheets that face +Z, green for the others
        for (const VertexArray& array : scene.vertex_arrays)
            for (const glm::vec3& normal : array.normals)
                colors.emplace_back(normal.z > 0, normal.z < 0, 0);
        Picture picture;
        picture.scene = &scene;
        picture.radiance = colors;
        picture.width = picture.height = 48;
        picture.samples = 1;
        for (const float side : {1.0f, -1.0f}) {
            picture.camera = {
                {0.3f * side, 0.2f, 3 * side}, {0, 0, 0}, {0, 1, 0}, 0.4f}; // filled by the sheet
            for (const glm::vec3& pixel : render_rays(picture, TraceScene(scene)).pixels)
                ASSERT_LT(glm::distance(pixel, side > 0 ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)), 1e-5f);
        }
    }
}

TEST(RayRenderer, CutOutsDoNotHideCoincidentSurfaces) {
    const auto sheet = test::SceneBuilder().quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}).build();
    Scene scene = test::join({sheet, sheet, sheet});
    for (const std::size_t cut : {0u, 2u}) {
        scene.materials[scene.primitives[cut].material].alpha_mode = AlphaMode::mask;
        scene.materials[scene.primitives[cut].material].base_color = {0, 0, 0, 0};
    }
    const std::vector<glm::vec3> white(scene.receivers(), glm::vec3(1));
    Picture picture;
    picture.scene = &scene;
    picture.radiance = white;
    picture.width = picture.height = 32;
    picture.camera = {{0.3f, 0.2f, 3}, {0, 0, 0}, {0, 1, 0}, 0.4f};
    for (const glm::vec3& pixel : render_rays(picture, TraceScene(scene)).pixels)
        ASSERT_LT(glm::distance(pixel, glm::vec3(1)), 1e-5f);
}

TEST(LightMeter, MeasuresTheModelAndNotTheSky) {
    // A sheet of base color c before a bright sky: its left half emits 2 c, its right half 6 c.
    const glm::vec3 color(0.5f, 0.25f, 0.125f);
    const Scene scene = test::join(
        {test::painted(test::SceneBuilder().quad({-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}).build(),
                       color),
         test::painted(test::SceneBuilder().quad({0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0}).build(),
                       color),
         test::painted(test::SceneBuilder().quad({-9, -9, 1}, {-9, 9, 1}, {9, 9, 1}, {9, -9, 1}).build(),
                       glm::vec3(1))}); // its back is culled
    const Image sky{1, 1, {glm::vec3(1e4f)}};
    Picture picture;
    picture.scene = &scene;
    picture.background.image = &sky;
    picture.width = 640;
    picture.height = 320;
    picture.camera = {{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.5f};
    const std::size_t right = scene.vertex_arrays[1].first_receiver,
                      behind = scene.vertex_arrays[2].first_receiver;
    const LightMeter meter(picture, RayScene(scene));
    std::vector<glm::vec3> radiance;
    for (const std::uint32_t receiver : meter.receivers()) {
        ASSERT_LT(receiver, behind); // only of the two sheets
        radiance.emplace_back(receiver < right ? 2.0f : 6.0f);
    }
    const float expected = 4 * (0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b);
    EXPECT_NEAR(meter.luminance(radiance), expected, 1e-4f * expected);
    EXPECT_NEAR(exposure_for(expected) * expected, 0.22f, 1e-6f);
    picture.camera.position = {0, 0, -10}; // only the distant white sheet is visible
    const LightMeter from_behind(picture, RayScene(scene));
    for (const std::uint32_t receiver : from_behind.receivers())
        EXPECT_GE(receiver, behind);
}

TEST(LightMeter, MeasuresVisibleTexels) {
    // Two triangles with a lightmap that is bright in the middle and dark at all corners.
    Scene scene = test::painted(
        test::SceneBuilder().quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}).build(), glm::vec3(0.5f));
    VertexArray& vertices = scene.vertex_arrays[0];
    vertices.texcoords.emplace_back();
    for (const glm::vec3& p : vertices.positions)
        vertices.texcoords[0].emplace_back(0.5f + 0.5f * p.x, 0.5f + 0.5f * p.y);
    const LightmapLayout layout{{{16, 16, false}}, {{0, 0}}};
    std::vector<glm::vec3> texels(layout.texels(), glm::vec3(0));
    for (int y = 4; y < 12; ++y)
        for (int x = 4; x < 12; ++x)
            texels[static_cast<std::size_t>(16 * y + x)] = glm::vec3(8);
    Picture picture;
    picture.scene = &scene;
    picture.in_shader.lightmaps = {.layout = &layout, .radiance = texels};
    picture.width = picture.height = 480;
    picture.samples = 1;
    picture.camera = {{0, 0, 20}, {0, 0, 0}, {0, 1, 0}, 0.2f};
    const std::vector<glm::vec3> unused(scene.receivers(), glm::vec3(0));
    picture.radiance = unused;
    const LightMeter meter(picture, RayScene(scene));
    std::vector<glm::vec3> radiance;
    for (const std::uint32_t texel : meter.receivers())
        radiance.push_back(texels[texel]);
    // A quarter of the sheet has 8 times 0.5; rays have a distance of 2 % of the sheet.
    EXPECT_NEAR(meter.luminance(radiance), 1, 0.05);
    glm::vec3 shown(0);
    for (const glm::vec3& pixel : render_rays(picture, TraceScene(scene)).pixels)
        shown += pixel;
    const float covered = std::pow(1 / (20 * std::tan(0.1f)), 2.0f); // fraction of the picture
    EXPECT_NEAR(meter.luminance(radiance), shown.g / (480.0f * 480.0f * covered), 0.05f);
}

TEST(GlRenderer, RejectsPicturesLargerThanTheDevice) {
    const auto context = GlContext::create(GlDevice::any);
    ASSERT_TRUE(context);
    const Scene scene = test::SceneBuilder().floor({0, 0, 0}, 1).build();
    const std::vector<glm::vec3> white(scene.receivers(), glm::vec3(1));
    Picture picture;
    picture.scene = &scene;
    picture.radiance = white;
    picture.camera = automatic_camera(scene, 1, 0.6f);
    picture.width = 100000;
    EXPECT_THROW(render_gl(picture, *context), Error);
}

} // namespace
} // namespace prt

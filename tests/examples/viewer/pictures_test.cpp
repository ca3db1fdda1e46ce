// Compares every picture of the viewer, drawn with the available driver, with an independent computation.

#include "gpu/offscreen.h"
#include "pictures/frame_renderer.h"

#include "bake/reference/path_tracer.h"
#include "bake/reference/ray_renderer.h"
#include "compress/study/receiver_colors.h"
#include "prt/bake/bake.h"
#include "prt/compress/compress.h"
#include "prt/gl/gl_renderer.h"
#include "prt/render/tone_map.h"
#include "support/scene_builder.h"

#include <epoxy/gl.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

using prt::test::SceneBuilder;

constexpr int kWidth = 192, kHeight = 108;

/// A sphere on a floor.
prt::Scene ball() {
    return prt::test::painted(
        SceneBuilder().floor({0, -0.5f, 0}, 1.5f, 40).sphere({0, 0, 0}, 0.5f, 40).build(),
        {0.7f, 0.5f, 0.3f});
}

/// A floor and a wall that rises from it at z = 0, both far and wide.
prt::Scene corner() {
    return SceneBuilder()
        .quad({-8, 0, 0}, {-8, 0, 8}, {8, 0, 8}, {8, 0, 0})
        .quad({-8, 0, 0}, {8, 0, 0}, {8, 8, 0}, {-8, 8, 0})
        .build();
}

prt::Light uneven_light() {
    return prt::sum(prt::overcast_sky(6, {1, 0.9f, 0.8f}),
                    prt::cone_light(6, glm::normalize(glm::vec3(1, 0.5f, 0.8f)), 0.5, {3, 2.5f, 2}));
}

class ViewerPictures : public testing::Test {
protected:
    void SetUp() override {
        std::string why;
        context = prt::GlContext::create(prt::GlDevice::any, &why);
        ASSERT_TRUE(context) << why;
        renderer = std::make_unique<FrameRenderer>();
        renderer->resize({kWidth, kHeight, 1});
        settings.drawing.textured = false;
        settings.drawing.background = false;
        load(ball());
    }
    void TearDown() override {
        gpu.reset();
        renderer.reset();
    }

    void load(prt::Scene scene) {
        model = make_model(std::move(scene), "test");
        gpu = std::make_unique<GpuModel>(model);
        light = uneven_light();
        gpu->set_light(light);
        view.camera = prt::automatic_camera(model->scene, float{kWidth} / float{kHeight}, 0.6f);
    }

    prt::Image drawn(PictureKind kind, int side = 1) {
        renderer->draw(side, kind, *gpu, settings.drawing, view, {0, kWidth});
        alpha.clear();
        return renderer->read(side, &alpha);
    }

    prt::Picture picture_of(std::span<const glm::vec3> radiance) const {
        prt::Picture picture = viewer::picture_of(*model, radiance, view.camera, kWidth, kHeight);
        picture.textured = settings.drawing.textured;
        return picture;
    }
    prt::Image rays(std::span<const glm::vec3> radiance) const {
        return prt::render_rays(picture_of(radiance), *model->trace);
    }

    bool inside(int x, int y, int margin = 1) const {
        for (int dy = -margin; dy <= margin; ++dy)
            for (int dx = -margin; dx <= margin; ++dx) {
                const int nx = x + dx, ny = y + dy;
                if (nx < 0 || ny < 0 || nx >= kWidth || ny >= kHeight ||
                    alpha[static_cast<std::size_t>(ny * kWidth + nx)] < 0.5f)
                    return false;
            }
        return true;
    }

    /// Returns the mean absolute difference relative to the mean, over pixels whose neighbours all show a
    /// surface. `most` excludes the silhouette of the ball against the floor: it is the maximum difference of
    /// neighbours on one surface.
    double mean_difference(const prt::Image& a, const prt::Image& b, float most = 0.2f) const {
        double difference = 0, mean = 0;
        std::size_t compared = 0, surface = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                if (!inside(x, y))
                    continue;
                ++surface;
                const glm::vec3 d = glm::abs(a.at(x, y) - b.at(x, y));
                if (std::max({d.r, d.g, d.b}) > most)
                    continue;
                ++compared;
                difference += static_cast<double>(d.r + d.g + d.b);
                mean += static_cast<double>(b.at(x, y).r + b.at(x, y).g + b.at(x, y).b);
            }
        EXPECT_GT(surface, std::size_t{kWidth} * kHeight / 8);
        EXPECT_GT(compared, surface * 95 / 100);
        return difference / mean;
    }

    prt::Transfer baked(int rays_per_receiver = 64) {
        prt::BakeOptions options;
        options.rays = rays_per_receiver;
        options.bounces = 1;
        options.tracer.backend = prt::Backend::cpu;
        return prt::bake(model->scene, options).baked.transfer;
    }
    prt::ClusteredTransfer compressed(const prt::Transfer& transfer) {
        const prt::CompressOptions options{.clusters = 24, .coding = prt::preset_u32()};
        return prt::compress(transfer, {model->areas, model->edges}, options).transfer;
    }

    std::unique_ptr<prt::GlContext> context;
    std::unique_ptr<FrameRenderer> renderer;
    std::shared_ptr<const Model> model;
    std::unique_ptr<GpuModel> gpu;
    prt::Light light;
    Settings settings;
    FrameView view;
    std::vector<float> alpha;
};

/// A sky with a separate sun.
struct SeparateSun {
    std::vector<prt::Sun> suns{{glm::normalize(glm::vec3(0.6f, 1, 0.4f)), {3, 2.5f, 2}, 0.01}};
    prt::Lighting lighting{prt::overcast_sky(6, {0.3f, 0.4f, 0.6f}), prt::as_light(suns[0], 6)};
};

// Half precision of the target is 0.05 %, and both interpolate between vertices.
constexpr double kSame = 0.003;

TEST_F(ViewerPictures, RawTransferMatchesCpp) {
    const prt::Transfer transfer = baked();
    gpu->set_raw(transfer);
    EXPECT_LT(mean_difference(drawn(PictureKind::prt), rays(prt::exit_radiance(transfer, light))), kSame);
    settings.drawing.textured = true;
    EXPECT_LT(mean_difference(drawn(PictureKind::prt), rays(prt::exit_radiance(transfer, light))), kSame);
    settings.drawing.deferred = true; // base color in 8 bits
    EXPECT_LT(mean_difference(drawn(PictureKind::prt), rays(prt::exit_radiance(transfer, light))), 0.006);
    // A different light.
    light = prt::rotated_about_y(light, 2);
    gpu->set_light(light);
    EXPECT_LT(mean_difference(drawn(PictureKind::prt), rays(prt::exit_radiance(transfer, light))), 0.006);
}

TEST_F(ViewerPictures, ColoredTransferMatchesCpp) {
    const prt::Transfer transfer = baked();
    ASSERT_EQ(transfer.layout.channels(), 3);
    gpu->set_raw(transfer);
    EXPECT_LT(mean_difference(drawn(PictureKind::prt), rays(prt::exit_radiance(transfer, light))), kSame);
}

TEST_F(ViewerPictures, SingleChannelTransferMatchesCpp) {
    const prt::Transfer colored = prt::as_combined(baked());
    prt::Transfer white = prt::zero_transfer(colored.layout.order, 1, colored.receivers());
    for (std::size_t p = 0; p < white.receivers(); ++p)
        std::copy_n(colored.vector(p).begin(), white.dimension(), white.vector(p).begin());
    gpu->set_raw(white);
    EXPECT_LT(mean_difference(drawn(PictureKind::prt), rays(prt::exit_radiance(white, light))), kSame);
}

TEST_F(ViewerPictures, RawTransferDoesNotDependOnRanges) {
    const prt::Transfer transfer = baked();
    gpu->set_raw(transfer);
    const prt::Image whole = drawn(PictureKind::prt);
    gpu = std::make_unique<GpuModel>(model, 256);
    gpu->set_light(light);
    gpu->set_raw(transfer);
    EXPECT_EQ(drawn(PictureKind::prt).pixels, whole.pixels);
}

TEST_F(ViewerPictures, CompressedTransferMatchesCpp) {
    const prt::ClusteredTransfer transfer = compressed(baked());
    gpu->set_compressed(transfer);
    const auto radiance = prt::exit_radiance(transfer, light);
    EXPECT_LT(mean_difference(drawn(PictureKind::prt_compressed), rays(radiance)), kSame);
    settings.drawing.deferred = true;
    EXPECT_LT(mean_difference(drawn(PictureKind::prt_compressed), rays(radiance)), kSame);
}

TEST_F(ViewerPictures, UnshadowedIrradianceUsesNormalLobes) {
    // Three bands per pixel against three bands per vertex; the sphere's facets are fine.
    const auto radiance = prt::exit_radiance(prt::unshadowed_transfer(model->scene, 3), light);
    EXPECT_LT(mean_difference(drawn(PictureKind::unshadowed), rays(radiance)), 0.005);
    settings.drawing.deferred = true;
    EXPECT_LT(mean_difference(drawn(PictureKind::unshadowed), rays(radiance)), 0.006);
}

TEST_F(ViewerPictures, BakedOcclusionMatchesTracedOcclusion) {
    gpu->set_occlusion(ambient_occlusion(*model, {}));
    gpu->set_light(prt::constant_light(6, glm::vec3(1))); // R is then the occlusion itself
    const prt::Image picture = drawn(PictureKind::baked_ao);
    // Independent: paths of one vertex through every pixel.
    const prt::DistantLight white({4, 2, std::vector<glm::vec3>(8, glm::vec3(1))});
    prt::PathTraceOptions options;
    options.camera = view.camera;
    options.width = kWidth;
    options.height = kHeight;
    options.bounces = 0;
    options.textured = false;
    options.background = false;
    options.antialiased = false;
    prt::PathTracer tracer(*model->trace, white, options);
    for (int i = 0; i < 128; ++i)
        tracer.add_pass();
    // Remaining error: noise of 128 paths, and the cells of the floor at the contact.
    EXPECT_LT(mean_difference(picture, tracer.image(), 0.5f), 0.03);
    double sum = 0, reference = 0;
    for (std::size_t i = 0; i < alpha.size(); ++i)
        if (alpha[i] > 0.5f) {
            sum += static_cast<double>(picture.pixels[i].g);
            reference += static_cast<double>(tracer.image().pixels[i].g);
        }
    EXPECT_NEAR(sum / reference, 1, 0.01);
}

// The visible fraction of a floor at distance d from an infinite wall of height h: 1 - (1 - d / sqrt(d² +
// h²)) / 2. A lamp over it has no effect.
TEST_F(ViewerPictures, OcclusionOfVerticesByAWallIsItsClosedForm) {
    prt::Scene wall = SceneBuilder()
                          .floor({0, 0, 2}, 2, 16)
                          .quad({-400, 0, -0.001f}, {400, 0, -0.001f}, {400, 1, -0.001f}, {-400, 1, -0.001f})
                          .build();
    wall.lights.push_back({.name = "lamp", .position = {0, 1, 2}});
    const auto walled = make_model(wall, "wall");
    const std::vector<float> open = ambient_occlusion(*walled, {});
    double squared = 0, sum = 0, checked = 0;
    const prt::VertexArray& vertices = walled->scene.vertex_arrays[0];
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const glm::vec3& p = vertices.positions[v];
        if (p.y != 0 || p.z < 0.1f || p.z > 3.9f || std::abs(p.x) > 1.9f)
            continue;
        const double d = static_cast<double>(p.z);
        const double error = static_cast<double>(open[v]) - (1 - (1 - d / std::sqrt(d * d + 1)) / 2);
        squared += error * error;
        sum += error;
        checked += 1;
    }
    EXPECT_GT(checked, 100);
    // 256 independent rays would err by sqrt(0.2 · 0.8 / 256) = 0.025; a net by less than half of that.
    EXPECT_LT(std::sqrt(squared / checked), 0.0125);
    EXPECT_LT(std::abs(sum / checked), 4 * 0.0125 / std::sqrt(checked));
}

TEST_F(ViewerPictures, DeferredOcclusionDiffersFromForwardByLessThanItsFiveBits) {
    gpu->set_occlusion(ambient_occlusion(*model, {}));
    gpu->set_light(prt::constant_light(6, glm::vec3(1)));
    const prt::Image forward = drawn(PictureKind::baked_ao);
    settings.drawing.deferred = true;
    for (const bool dithered : {false, true}) {
        settings.drawing.dithered = dithered;
        const prt::Image deferred = drawn(PictureKind::baked_ao);
        float largest = 0;
        for (std::size_t i = 0; i < alpha.size(); ++i)
            if (alpha[i] > 0.5f)
                largest = std::max(largest, std::abs(forward.pixels[i].g - deferred.pixels[i].g));
        EXPECT_LT(largest, (dithered ? 1.0f : 0.5f) / 31 + 0.002f);
        EXPECT_GT(largest, 0.2f / 31); // five bits, not more
    }
}

TEST_F(ViewerPictures, DitheringIsRightOnAverage) {
    load(SceneBuilder().floor({0, 0, 0}, 50, 1).build());
    view.camera = {{0, 4, 1}, {0, 0, 0}, {0, 1, 0}, 0.6f};
    settings.drawing.deferred = true;
    for (const float open : {0.1f, 0.3871f, 0.513f, 0.9f, 1.0f, 0.0f}) {
        gpu->set_occlusion(std::vector<float>(model->scene.receivers(), open));
        const auto mean = [&] {
            drawn(PictureKind::baked_ao);
            double sum = 0;
            const auto levels = renderer->read_gbuffer_occlusion();
            for (const std::uint8_t level : levels)
                sum += level;
            return sum / static_cast<double>(levels.size()) / 31;
        };
        settings.drawing.dithered = true;
        // Thresholds come in steps of 1/64 of a level, on 192 x 108 pixels that 8 does not divide.
        EXPECT_NEAR(mean(), static_cast<double>(open), 1.0 / 31 / 32) << open;
        settings.drawing.dithered = false;
        EXPECT_NEAR(mean(), std::round(static_cast<double>(open) * 31) / 31, 1e-9) << open;
    }
}

class Ssao : public ViewerPictures, public testing::WithParamInterface<PictureKind> {
protected:
    std::vector<float> occlusion() {
        drawn(GetParam());
        return renderer->read_ssao();
    }
    /// Rows are from the bottom.
    static float at(const std::vector<float>& values, const glm::vec2& pixel) {
        return values[static_cast<std::size_t>((kHeight - 1 - static_cast<int>(pixel.y)) * kWidth +
                                               static_cast<int>(pixel.x))];
    }
    float at_position(const std::vector<float>& values, const glm::vec3& point) const {
        const glm::vec4 clip = prt::view_projection(view.camera, model->box, float{kWidth} / float{kHeight}) *
                               glm::vec4(point, 1);
        return at(values,
                  {(clip.x / clip.w * 0.5f + 0.5f) * kWidth, (0.5f - clip.y / clip.w * 0.5f) * kHeight});
    }
};

INSTANTIATE_TEST_SUITE_P(Both, Ssao, testing::Values(PictureKind::ssao, PictureKind::ssao_normals));

TEST_P(Ssao, LeavesAFlatPlaneOpen) {
    load(SceneBuilder().floor({0, 0, 0}, 30, 8).build());
    for (const float height : {1.0f, 3.0f, 8.0f}) {
        view.camera = {{0, height, 4}, {0, 0, 0}, {0, 1, 0}, 0.6f};
        const auto values = occlusion();
        for (std::size_t i = 0; i < values.size(); ++i)
            if (alpha[alpha.size() - kWidth * (1 + i / kWidth) + i % kWidth] > 0.5f) {
                ASSERT_GT(values[i], 0.97f) << "seen from " << height << ", pixel " << i;
            }
    }
}

TEST_P(Ssao, DarkensOnlyNearACorner) {
    load(corner());
    view.camera = {{0, 3, 9}, {0, 1, 0}, {0, 1, 0}, 0.6f};
    settings.drawing.ssao.radius = 0.6f / model->radius;
    const auto values = occlusion();
    const float at_corner = at_position(values, {0, 0.05f, 0}), near = at_position(values, {0, 0, 0.3f}),
                far = at_position(values, {0, 0, 2}), wall = at_position(values, {0, 2, 0});
    EXPECT_LT(at_corner, 0.85f);
    EXPECT_LT(at_corner, near + 0.03f);
    EXPECT_GT(far, 0.97f);
    EXPECT_GT(wall, 0.97f);
    settings.drawing.ssao.intensity = 2;
    const auto stronger = occlusion();
    EXPECT_NEAR(at_position(stronger, {0, 0.05f, 0}), at_corner * at_corner, 0.04f);
    settings.drawing.ssao.intensity = 1;
    settings.drawing.ssao.radius *= 3; // reaches farther
    EXPECT_LT(at_position(occlusion(), {0, 0, 0.7f}), at_position(values, {0, 0, 0.7f}) - 0.02f);
}

TEST_P(Ssao, HasNoHaloesAroundDistantForeground) {
    // A wall, and a board two units before it.
    load(SceneBuilder()
             .quad({-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0})
             .quad({-1, -8, 4}, {0, -8, 4}, {0, 8, 4}, {-1, 8, 4})
             .build());
    view.camera = {{0, 0, 12}, {0, 0, 0}, {0, 1, 0}, 0.6f};
    settings.drawing.ssao.radius = 0.4f / model->radius;
    const auto values = occlusion();
    for (float x = 0.1f; x < 2; x += 0.1f) // next to the board's edge, as seen from the camera
        EXPECT_GT(at_position(values, {1.5f * x, 0, 0}), 0.9f) << x;
}

TEST_P(Ssao, ScalesOnlyIrradiance) {
    load(corner());
    settings.drawing.textured = true;
    const prt::Image open = drawn(PictureKind::unshadowed), shaded = drawn(GetParam());
    const auto values = renderer->read_ssao();
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (!inside(x, y))
                continue;
            const float expected =
                open.at(x, y).g * at(values, {static_cast<float>(x), static_cast<float>(y)});
            ASSERT_NEAR(shaded.at(x, y).g, expected, 0.01f * open.at(x, y).g + 1e-4f);
        }
}

TEST_F(ViewerPictures, NumbersShowTheirColors) {
    const prt::ClusteredTransfer transfer = compressed(baked());
    const prt::Transfer raw = baked();
    const auto reference = prt::exit_radiance(raw, light),
               approximation = prt::exit_radiance(transfer, light);
    const std::pair<PictureKind, std::vector<glm::vec3>> pictures[] = {
        {PictureKind::clusters, prt::cluster_colors(transfer)},
        {PictureKind::components, prt::component_colors(transfer)},
        {PictureKind::error, prt::error_colors(reference, approximation, model->areas)},
        {PictureKind::seams, prt::seam_colors(reference, approximation, model->areas, model->edges,
                                              transfer.receivers.cluster_indices())}};
    for (const auto& [kind, colors] : pictures) {
        EXPECT_FALSE(gpu->can_draw(kind));
        gpu->set_numbers(kind, colors);
        EXPECT_TRUE(gpu->can_draw(kind));
        EXPECT_LT(mean_difference(drawn(kind), rays(colors), 1), 0.02)
            << name_of(kind).id; // edges of the ball
    }
}

TEST_F(ViewerPictures, DoNotDependOnCulling) {
    gpu->set_raw(baked());
    view.camera.target = {0.4f, -0.2f, 0};
    view.camera.position = {0.7f, 0, 1.1f};
    settings.drawing.culling = false;
    const prt::Image all = drawn(PictureKind::prt);
    EXPECT_EQ(gpu->drawn_triangles(), model->scene.triangles());
    settings.drawing.culling = true;
    const prt::Image culled = drawn(PictureKind::prt);
    EXPECT_LT(gpu->drawn_triangles(), model->scene.triangles() * 3 / 4);
    EXPECT_EQ(all.pixels, culled.pixels);
}

TEST_F(ViewerPictures, DifferenceSumsPixelsShownByBoth) {
    gpu->set_raw(baked());
    const prt::Image a = drawn(PictureKind::unshadowed, 0), b = drawn(PictureKind::prt, 1);
    double squared = 0, norm = 0, mean = 0, pixels = 0;
    for (std::size_t i = 0; i < alpha.size(); ++i) {
        if (alpha[i] < 0.5f)
            continue;
        const glm::dvec3 d = glm::dvec3(a.pixels[i]) - glm::dvec3(b.pixels[i]);
        squared += glm::dot(d, d);
        norm += glm::dot(glm::dvec3(b.pixels[i]), glm::dvec3(b.pixels[i]));
        mean += glm::dot(glm::dvec3(b.pixels[i]), glm::dvec3(1.0 / 3));
        pixels += 1;
    }
    const Difference difference = renderer->difference();
    EXPECT_EQ(difference.pixels, pixels);
    EXPECT_NEAR(difference.relative_l2, std::sqrt(squared / norm), 1e-5);
    EXPECT_NEAR(difference.mean, mean / pixels, 1e-5);
    EXPECT_GT(difference.relative_l2, 0.05); // there is a shadow
}

TEST_F(ViewerPictures, OnTheScreenAreToneMappedAsInCppAndSplit) {
    gpu->set_raw(baked());
    settings.drawing.samples = 2;
    renderer->resize({kWidth, kHeight, 2});
    view.exposure = prt::automatic_exposure(light);
    settings.split = 0.25f;
    const prt::Image left = drawn(PictureKind::unshadowed, 0), right = drawn(PictureKind::prt, 1);
    const Offscreen screen(kWidth, kHeight);
    renderer->composite(screen.framebuffer(), settings, view, {PictureKind::unshadowed, PictureKind::prt}, 1);
    std::vector<glm::u8vec3> shown(std::size_t{kWidth} * kHeight);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, screen.framebuffer());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, shown.data());
    const auto expected_left = prt::tone_mapped(left, 2, view.exposure, prt::ToneMap::filmic),
               expected_right = prt::tone_mapped(right, 2, view.exposure, prt::ToneMap::filmic);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto& expected = x < kWidth / 4 ? expected_left : expected_right;
            const glm::ivec3 a(expected[static_cast<std::size_t>(y * kWidth + x)]),
                b(shown[static_cast<std::size_t>((kHeight - 1 - y) * kWidth + x)]);
            ASSERT_LE(std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}), 1)
                << x << ", " << y;
        }
}

TEST_F(ViewerPictures, WiresAreDarkAtTriangleEdges) {
    load(SceneBuilder().floor({0, 0, 0}, 1, 1).build()); // two triangles, one diagonal
    gpu->set_light(prt::constant_light(6, glm::vec3(1)));
    view.camera = {{0, 3, 0.01f}, {0, 0, 0}, {0, 0, -1}, 0.6f};
    const prt::Image plain = drawn(PictureKind::unshadowed);
    settings.drawing.wireframe = true;
    const prt::Image wires = drawn(PictureKind::unshadowed);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
        changed += plain.pixels[i] != wires.pixels[i];
    // Four sides and the diagonal, some 110 pixels each.
    EXPECT_GT(changed, 300u);
    EXPECT_LT(changed, 1200u);
    float darkest = 1; // across the diagonal
    for (int dx = -2; dx <= 2; ++dx)
        darkest = std::min(darkest, wires.at(kWidth / 2 + dx, kHeight / 2).g);
    EXPECT_LT(darkest, 0.5f);
}

TEST_F(ViewerPictures, SeparateSunsMatchTheRenderer) {
    const SeparateSun separate_light;
    const prt::Transfer transfer = baked();
    const prt::ClusteredTransfer small = compressed(transfer);
    gpu->set_raw(transfer);
    gpu->set_compressed(small);
    gpu->set_lighting(separate_light.lighting, separate_light.suns);
    const auto rendered = [&](const std::vector<glm::vec3>& radiance) {
        prt::Picture picture = picture_of(radiance);
        picture.suns = separate_light.suns;
        return prt::render_gl(picture, *context);
    };
    const prt::Image raw = rendered(prt::exit_radiance(transfer, separate_light.lighting));
    EXPECT_LT(mean_difference(drawn(PictureKind::prt), raw), kSame);
    EXPECT_LT(mean_difference(drawn(PictureKind::prt_compressed),
                              rendered(prt::exit_radiance(small, separate_light.lighting))),
              kSame);
    settings.drawing.deferred = true;
    EXPECT_LT(mean_difference(drawn(PictureKind::prt), raw), kSame);
}

TEST_F(ViewerPictures, AddEqualSunsToEverySkyLighting) {
    const SeparateSun separate_light;
    prt::Lighting black = separate_light.lighting;
    for (glm::vec3& c : black.sky.coefficients)
        c = glm::vec3(0);
    gpu->set_lighting(black, separate_light.suns);
    const std::vector<glm::vec3> none(model->scene.receivers(), glm::vec3(0));
    prt::Picture picture = picture_of(none);
    picture.suns = separate_light.suns;
    const prt::Image expected = prt::render_gl(picture, *context);
    for (const PictureKind kind : {PictureKind::unshadowed, PictureKind::ssao, PictureKind::ssao_normals})
        EXPECT_LT(mean_difference(drawn(kind), expected), kSame) << name_of(kind).id;
    settings.drawing.deferred = true;
    EXPECT_LT(mean_difference(drawn(PictureKind::unshadowed), expected), kSame);
}

TEST_F(ViewerPictures, CombinedTransferUsesSunsAsSky) {
    const SeparateSun separate_light;
    const prt::Transfer transfer = baked();
    const prt::Transfer whole = prt::as_combined(transfer);
    gpu->set_raw(whole);
    gpu->set_lighting(separate_light.lighting, separate_light.suns);
    EXPECT_TRUE(gpu->takes_suns_as_sky(PictureKind::prt));
    EXPECT_FALSE(gpu->takes_suns_as_sky(PictureKind::unshadowed));
    EXPECT_LT(
        mean_difference(drawn(PictureKind::prt), rays(prt::exit_radiance(whole, separate_light.lighting))),
        kSame);
    gpu->set_raw(transfer);
    EXPECT_FALSE(gpu->takes_suns_as_sky(PictureKind::prt));
}

} // namespace
} // namespace viewer

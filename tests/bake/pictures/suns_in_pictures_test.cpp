// Tests suns in pictures by rays: closed forms of shadows, and comparison with the path tracer and light at
// vertices.

#include "bake/pipeline/sun_radiance.h"
#include "bake/reference/light_meter.h"
#include "bake/reference/path_tracer.h"
#include "bake/reference/ray_renderer.h"
#include "prt/render/tone_map.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

using test::SceneBuilder;

using std::numbers::pi;

/// A scene without light but that of suns, seen without textures.
struct SunnyPicture {
    TraceScene traced;
    std::vector<glm::vec3> black;
    Picture picture;
    RayPictureOptions options;

    explicit SunnyPicture(const Scene& scene, const TraceSceneOptions& tracing = {})
        : traced(scene, {}, tracing), black(scene.receivers(), glm::vec3(0)) {
        picture.scene = &scene;
        picture.radiance = black;
        picture.textured = false;
        picture.width = picture.height = 32;
        picture.samples = 1;
        look_from_above({0, 5, 0});
    }
    void look_from_above(const glm::vec3& from) {
        picture.camera = {from, {from.x, 0, from.z}, {0, 0, -1}, 0.4f};
    }
    Image lit_by(const std::vector<Sun>& suns) {
        picture.suns = suns;
        Image image = render_rays(picture, traced, options);
        picture.suns = {};
        return image;
    }
};

glm::vec3 towards_sun_at(double degrees) {
    const double angle = degrees * pi / 180;
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
}

void expect_all(const Image& image, const glm::dvec3& radiance, double tolerance) {
    for (const glm::vec3& pixel : image.pixels)
        ASSERT_LT(glm::distance(glm::dvec3(pixel), radiance), tolerance) << pixel.x << " for " << radiance.x;
}

TEST(SunsInPictures, FallOnAnOpenFloorWithTheCosine) {
    const Scene floor = SceneBuilder().floor({0, 0, 0}, 4, 3).build();
    const glm::dvec3 irradiance(3, 2, 1);
    for (const int samples : {1, 2, 3})
        for (const double half_angle : {0.0, 0.005, 0.1})
            for (const double elevation : {90.0, 40.0, 7.0}) {
                SunnyPicture shown(floor);
                shown.picture.samples = samples;
                const Image image =
                    shown.lit_by({{towards_sun_at(elevation), glm::vec3(irradiance), half_angle}});
                const glm::dvec3 expected = irradiance / pi * std::sin(elevation * pi / 180);
                // The cosine varies by the half angle over the disc; a sample of 16 / 9 takes 2 points of it.
                expect_all(image, expected, 1e-5 + half_angle * glm::length(irradiance) / pi);
                expect_all(downsampled(image, samples), expected,
                           1e-5 + 0.1 * half_angle * glm::length(irradiance) / pi);
            }
    expect_all(SunnyPicture(floor).lit_by({{towards_sun_at(-5), glm::vec3(1), 0.01}}), glm::dvec3(0), 1e-9);
}

/// A long wall. Seen from a point of the floor, its top covers a segment of the sun's disc: all of it in the
/// umbra, none beyond the penumbra. With t the height in the disc in half angles a, the sine of the elevation
/// e is sin e + a t cos e; the expected value is its mean over the disc above t = u.
TEST(SunsInPictures, CastTheUmbraAndPenumbraOfAWall) {
    const Scene scene =
        test::join({SceneBuilder().floor({0, 0, 0}, 20, 1).build(),
                    SceneBuilder().quad({0, 0, 400}, {0, 0, -400}, {0, 1, -400}, {0, 1, 400}).build()});
    const double elevation = 30 * pi / 180, half_angle = 0.05;
    SunnyPicture shown(scene);
    shown.options.sun_rays = 1024;
    shown.look_from_above({-1.75f, 2, 0});
    const Image image = shown.lit_by({{towards_sun_at(30), glm::vec3(1), half_angle}});
    const CameraFrame frame = camera_frame(shown.picture.camera);
    int umbra = 0, penumbra = 0, lit = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const glm::dvec3 along = view_direction(frame, image.width, image.height, x + 0.5, y + 0.5);
            const double distance = 1.75 - 2 * along.x / -along.y; // distance of the point from the wall
            const double u = (std::atan2(1.0, distance) - elevation) / half_angle;
            const double edge = std::clamp(u, -1.0, 1.0), across = std::sqrt(1 - edge * edge);
            const double share = 0.5 - (edge * across + std::asin(edge)) / pi;
            const double sine = share * std::sin(elevation) +
                                half_angle * std::cos(elevation) * 2 / (3 * pi) * std::pow(across, 3);
            (u > 1 ? umbra : u < -1 ? lit : penumbra) += 1;
            // The curvature of the disc, and points on its edge out of 1024.
            ASSERT_NEAR(static_cast<double>(image.at(x, y).x), sine / pi, std::abs(u) > 1.02 ? 1e-4 : 1e-3)
                << distance;
        }
    EXPECT_GT(umbra, 100);
    EXPECT_GT(penumbra, 100);
    EXPECT_GT(lit, 100);
}

TEST(SunsInPictures, AddUp) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 2, 2).sphere({0, 0.8f, 0}, 0.5f, 12).build();
    const Sun a{towards_sun_at(50), {1, 2, 3}, 0.02}, b{towards_sun_at(120), {4, 1, 0}, 0.0};
    SunnyPicture shown(scene);
    const Image first = shown.lit_by({a}), second = shown.lit_by({b}), both = shown.lit_by({a, b});
    for (std::size_t i = 0; i < both.pixels.size(); ++i)
        ASSERT_LT(glm::distance(both.pixels[i], first.pixels[i] + second.pixels[i]), 1e-5f);
}

/// With base color 0.5 a leaf reflects 0.3 and transmits 0.4; as exit radiance for albedo 1 both are divided
/// by the base color (docs/math.md, eq. 38).
TEST(SunsInPictures, LightThroughLeaves) {
    Scene leaf = test::painted(SceneBuilder().floor({0, 0, 0}, 4, 1).build(), glm::vec3(0.5f), true);
    leaf.materials[0].transmission.factor = 0.4f;
    SunnyPicture shown(leaf);
    for (const bool from_below : {false, true}) { // seen from either side
        shown.picture.camera = {{0, from_below ? -5.0f : 5.0f, 0}, {0, 0, 0}, {0, 0, -1}, 0.4f};
        const Sun before{{0, from_below ? -1 : 1, 0}, glm::vec3(1), 0.01},
            behind{-before.towards, glm::vec3(1), 0.01};
        shown.picture.textured = true;
        expect_all(shown.lit_by({before}), glm::dvec3(0.3 / pi), 1e-4);
        expect_all(shown.lit_by({behind}), glm::dvec3(0.4 / pi), 1e-4);
        shown.picture.textured = false;
        expect_all(shown.lit_by({before}), glm::dvec3(0.6 / pi), 1e-4);
        expect_all(shown.lit_by({behind}), glm::dvec3(0.8 / pi), 1e-4);
    }
}

TEST(SunsInPictures, AreDimmedByBlendedSurfaces) {
    Scene pane = SceneBuilder().floor({0, 8, 0}, 4, 1).build(); // behind the camera
    pane.materials[0].alpha_mode = AlphaMode::blend;
    pane.materials[0].base_color.a = 0.25f;
    const Scene scene = test::join({SceneBuilder().floor({0, 0, 0}, 2, 1).build(), pane});
    expect_all(SunnyPicture(scene).lit_by({{{0, 1, 0}, glm::vec3(1), 0.01}}), glm::dvec3(0.75 / pi), 1e-4);
}

TEST(SunsInPictures, LeaveMediaToTransfer) {
    const Scene floor = SceneBuilder().floor({0, 0, 0}, 4, 1).build();
    expect_all(SunnyPicture(floor, {.solid = {true}}).lit_by({{{0, 1, 0}, glm::vec3(1), 0.01}}),
               glm::dvec3(0), 1e-9);
    const Sun sun{{0, 1, 0}, glm::vec3(1), 0.01};
    for (const glm::vec3& r : sun_radiance(TraceScene(floor, {}, {.solid = {true}}), std::span(&sun, 1)))
        EXPECT_EQ(r, glm::vec3(0));
}

/// Tests normals that lean towards a sun below the floor, and away from one above it.
TEST(SunsInPictures, DoNotLeakOverTheEdgeOfASurface) {
    Scene floor = SceneBuilder().floor({0, 0, 0}, 4, 1).build();
    for (glm::vec3& normal : floor.vertex_arrays[0].normals)
        normal = glm::normalize(glm::vec3(1, 1, 0));
    SunnyPicture shown(floor);
    expect_all(shown.lit_by({{towards_sun_at(-20), glm::vec3(1), 0.0}}), glm::dvec3(0), 1e-9);
    expect_all(shown.lit_by({{towards_sun_at(160), glm::vec3(1), 0.0}}), glm::dvec3(0), 1e-9);
    expect_all(shown.lit_by({{towards_sun_at(60), glm::vec3(1), 0.0}}),
               glm::dvec3(std::cos(15 * pi / 180) / pi), 1e-5);
}

TEST(SunsInPictures, MatchThePathTracer) {
    const Scene scene = SceneBuilder().floor({0, -0.5f, 0}, 2, 3).sphere({0, 0.3f, 0}, 0.5f, 8).build();
    const Sun sun{glm::normalize(glm::vec3(0.5f, 0.8f, 0.6f)), {3, 2, 1}, 0};
    SunnyPicture shown(scene);
    shown.picture.camera = {{1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 0.6f};
    const Image image = shown.lit_by({sun});
    PathTraceOptions options;
    options.camera = shown.picture.camera;
    options.width = options.height = 32;
    options.bounces = 0;
    options.textured = options.antialiased = false;
    const DistantLight light({}, {{sun.towards, sun.irradiance}});
    PathTracer tracer(shown.traced, light, options);
    tracer.add_pass();
    const Image reference = tracer.image();
    int differing = 0; // a ray may pass an edge of a shadow on the other side
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        differing += glm::distance(image.pixels[i], reference.pixels[i]) > 1e-4f;
    EXPECT_LE(differing, 2);
}

TEST(SunsInPictures, LightVerticesLikeTheirReceivers) {
    const Scene scene = SceneBuilder().floor({0, -0.5f, 0}, 2, 9).sphere({0, 0.3f, 0}, 0.5f, 24).build();
    const Sun sun{glm::normalize(glm::vec3(0.5f, 0.8f, 0.6f)), glm::vec3(1), 0.08};
    SunnyPicture shown(scene);
    shown.options.sun_rays = 256;
    shown.picture.width = shown.picture.height = 1;
    const std::vector<glm::vec3> at_vertices = sun_radiance(shown.traced, std::span(&sun, 1));
    const VertexArray& vertices = scene.vertex_arrays[0];
    const std::vector<float> areas = receiver_areas(scene);
    int compared = 0, partly = 0;
    for (std::size_t p = 0; p < vertices.size(); p += 2) {
        // From close by, a little to the inside of the floor's edges.
        const glm::vec3 position = vertices.positions[p] * glm::vec3(0.9999f, 1, 0.9999f),
                        normal = vertices.normals[p];
        if (areas[p] == 0 || glm::dot(normal, sun.towards) < 0.2f)
            continue;
        shown.picture.camera = {position + 0.01f * normal, position, {0.3f, 0.5f, 0.8f}, 0.01f};
        const double pixel = static_cast<double>(shown.lit_by({sun}).pixels[0].x),
                     vertex = static_cast<double>(at_vertices[p].x);
        EXPECT_NEAR(pixel, vertex, 0.01) << p;
        ++compared;
        partly += vertex > 0.01 && vertex < 0.8 * static_cast<double>(glm::dot(normal, sun.towards)) / pi;
    }
    EXPECT_GT(compared, 100);
    EXPECT_GT(partly, 3); // in penumbrae
}

TEST(SunsInPictures, CountForTheExposure) {
    const Scene floor = test::painted(SceneBuilder().floor({0, 0, 0}, 4, 3).build(), {0.5f, 0.25f, 1});
    SunnyPicture shown(floor);
    shown.picture.textured = true;
    const Sun sun{towards_sun_at(30), {3, 2, 1}, 0};
    shown.picture.suns = std::span(&sun, 1);
    EXPECT_NEAR(static_cast<double>(sun_luminance(shown.picture, shown.traced)),
                (0.2126 * 1.5 + 0.7152 * 0.5 + 0.0722) * 0.5 / pi, 1e-5);
    shown.picture.suns = {};
    EXPECT_EQ(sun_luminance(shown.picture, shown.traced), 0);
}

} // namespace
} // namespace prt

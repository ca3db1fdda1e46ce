// Tests camera frames and default cameras.

#include "prt/render/camera.h"

#include "prt/core/error.h"
#include "prt/render/tone_map.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace prt {
namespace {

TEST(Camera, AutomaticCameraContainsTheScene) {
    for (const float scale : {1e-6f, 1.0f, 1e6f})
        for (const float aspect : {0.5f, 1.0f, 2.4f}) {
            const Scene scene =
                test::SceneBuilder().floor({3 * scale, 0, 0}, scale).sphere({0, scale, 0}, scale, 8).build();
            const glm::mat4 matrix =
                view_projection(automatic_camera(scene, aspect, 0.6f), bounds(scene), aspect);
            float widest = 0;
            for (const glm::vec3& p : scene.vertex_arrays[0].positions) {
                const glm::vec4 clip = matrix * glm::vec4(p, 1);
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_LE(std::abs(clip[axis]), clip.w) << scale << " " << aspect;
                widest = std::max({widest, std::abs(clip.x) / clip.w, std::abs(clip.y) / clip.w});
            }
            EXPECT_GT(widest, 0.7f); // and not from afar
        }
}

TEST(Camera, FrameAgreesWithTheMatrix) {
    const Camera camera{{1, 2, 5}, {0.5f, 0, -1}, {0, 1, 0}, 0.8f};
    const CameraFrame frame = camera_frame(camera);
    const glm::mat4 matrix = view_projection(camera, {glm::vec3(-3), glm::vec3(3)}, 1.5f);
    const glm::dvec3 point =
        glm::dvec3(camera.position) + 3.0 * (frame.forward + frame.right * (frame.half_height * 1.5 * 0.25) -
                                             frame.up * (frame.half_height * 0.5));
    const glm::vec4 clip = matrix * glm::vec4(glm::vec3(point), 1);
    EXPECT_NEAR(clip.x / clip.w, 0.25f, 1e-5f);
    EXPECT_NEAR(clip.y / clip.w, -0.5f, 1e-5f);
}

TEST(Camera, NearAndFarPlanesContainTheBox) {
    const Bounds box{{-1, -2, -3}, {2, 3, 1}};
    const auto corner = [&](int i) {
        return glm::vec3(i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y,
                         i & 4 ? box.high.z : box.low.z);
    };
    for (int octant = 0; octant < 8; ++octant) { // the camera looks from beyond a corner at the opposite one
        const Camera camera{1.5f * corner(octant), corner(7 - octant), {0, 1, 0}, 0.8f};
        const glm::mat4 matrix = view_projection(camera, box, 1);
        float nearest = 1, farthest = -1;
        for (int i = 0; i < 8; ++i) {
            const glm::vec4 clip = matrix * glm::vec4(corner(i), 1);
            nearest = std::min(nearest, clip.z / clip.w);
            farthest = std::max(farthest, clip.z / clip.w);
        }
        EXPECT_GE(nearest, -1) << octant;
        EXPECT_LE(farthest, 1) << octant;
        EXPECT_LT(nearest, -0.9f) << octant; // and no more than they need to
        EXPECT_GT(farthest, 0.98f) << octant;
    }
}

TEST(Camera, PixelRaysMatchTheProjection) {
    const Camera camera{{3, 2, 5}, {0.5f, -1, 0}, {0, 1, 0}, 0.8f};
    const glm::mat4 matrix = view_projection(camera, {glm::vec3(-1), glm::vec3(1)}, 1.5f);
    const CameraFrame frame = camera_frame(camera);
    for (const glm::dvec2 at : {glm::dvec2(0, 0), glm::dvec2(300, 200), glm::dvec2(70.5, 150.5)}) {
        const glm::vec3 direction(view_direction(frame, 300, 200, at.x, at.y));
        const glm::vec4 clip = matrix * glm::vec4(camera.position + 4.0f * direction, 1);
        EXPECT_NEAR(clip.x / clip.w, 2 * at.x / 300 - 1, 1e-5);
        EXPECT_NEAR(clip.y / clip.w, 1 - 2 * at.y / 200, 1e-5);
    }
}

TEST(Camera, LookingNowhereIsAnError) {
    EXPECT_THROW(camera_frame({{1, 1, 1}, {1, 1, 1}, {0, 1, 0}, 1}), Error);
    EXPECT_THROW(camera_frame({{0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 1}), Error);
    for (const float far : {2 * kFarthestCamera, -INFINITY, std::nanf("")}) {
        EXPECT_THROW(camera_frame({{far, 0, 0}, {0, 0, 0}, {0, 1, 0}, 1}), Error) << far;
        EXPECT_THROW(camera_frame({{0, 0, 1}, {0, 0, far}, {0, 1, 0}, 1}), Error) << far;
    }
}

TEST(ToneMap, SrgbCurvesAreInverse) {
    for (float v = 0; v <= 1; v += 0.01f)
        EXPECT_NEAR(srgb_decode(srgb_encode(v)), v, 1e-5f);
    EXPECT_NEAR(srgb_encode(0.5f), 0.7354f, 1e-3f);
}

TEST(ToneMap, AveragesSamplesAfterTheCurve) {
    const Image image{2, 2, {glm::vec3(100), glm::vec3(0), glm::vec3(0), glm::vec3(0)}};
    const auto pixels = tone_mapped(image, 2, 1, ToneMap::srgb);
    ASSERT_EQ(pixels.size(), 1u);
    EXPECT_EQ(pixels[0].r,
              std::lround(255 * srgb_encode(0.25f))); // one of four is white, not 100 times white
    EXPECT_NEAR(downsampled(image, 2).pixels[0].r, 25, 1e-4f);
}

TEST(ToneMap, FilmicRisesToWhite) {
    std::uint8_t last = 0;
    for (const float v : {0.0f, 0.01f, 0.1f, 0.5f, 1.0f, 4.0f, 100.0f, 1e20f}) {
        const auto pixel = tone_mapped({1, 1, {glm::vec3(v)}}, 1, 1, ToneMap::filmic)[0];
        EXPECT_GE(pixel.r, last);
        last = pixel.r;
    }
    EXPECT_EQ(last, 255);
}

} // namespace
} // namespace prt

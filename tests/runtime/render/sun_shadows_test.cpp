// Suns in pictures of OpenGL, by shadow maps: closed forms, and rays as the truth.

#include "bake/pipeline/sun_radiance.h"
#include "prt/core/error.h"
#include "prt/gl/gl_renderer.h"
#include "runtime/render/gl/sun_shadows.h"
#include "support/scene_builder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr int kAcross = 160, kDown = 120;

glm::vec3 from(double azimuth_degrees, double elevation_degrees) {
    const double a = azimuth_degrees * kHalfTurn / 180, e = elevation_degrees * kHalfTurn / 180;
    return {static_cast<float>(std::sin(a) * std::cos(e)), static_cast<float>(std::sin(e)),
            static_cast<float>(std::cos(a) * std::cos(e))};
}

class SunShadowPictures : public testing::Test {
protected:
    void SetUp() override {
        std::string why;
        context_ = GlContext::create(GlDevice::any, &why);
        ASSERT_TRUE(context_) << why;
    }

    /// Draws `scene` in black light, lit only by suns.
    Image lit(const Scene& scene, std::span<const Sun> suns, const Camera& camera,
              std::span<const Texture> textures = {}) const {
        const std::vector<glm::vec3> black(scene.receivers(), glm::vec3(0));
        Picture picture;
        picture.scene = &scene;
        picture.textures = textures;
        picture.radiance = black;
        picture.suns = suns;
        picture.camera = camera;
        picture.width = kAcross;
        picture.height = kDown;
        picture.samples = 1;
        return render_gl(picture, *context_);
    }
    Image lit(const Scene& scene, const Sun& sun, const Camera& camera) const {
        return lit(scene, std::span(&sun, 1), camera);
    }

    std::unique_ptr<GlContext> context_;
};

/// The point of a scene that a pixel shows.
struct Position {
    glm::vec3 position, face; ///< unit, towards the camera
    unsigned triangle;
};

std::optional<Position> seen_at(const RayScene& rays, const Scene& scene, const Camera& camera, double x,
                                double y) {
    const glm::vec3 along(view_direction(camera_frame(camera), kAcross, kDown, x, y));
    const auto face = [&](unsigned id) {
        const RayScene::Triangle at = rays.triangle(id);
        const Primitive& primitive = scene.primitives[at.primitive];
        const auto& positions = scene.vertex_arrays[primitive.vertices].positions;
        const glm::uvec3& t = primitive.triangles[at.triangle];
        return glm::normalize(glm::cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]));
    };
    const auto shows = [&](unsigned id) {
        return scene.materials[scene.primitives[rays.triangle(id).primitive].material].double_sided ||
               glm::dot(face(id), along) < 0;
    };
    const auto hit = rays.nearest({camera.position, along}, shows);
    if (!hit)
        return std::nullopt;
    const glm::vec3 normal = face(hit->triangle);
    return Position{camera.position + along * hit->distance, glm::dot(normal, along) > 0 ? -normal : normal,
                    hit->triangle};
}

/// Returns the unoccluded fraction of rays over the disc of `sun`; opaque surfaces only.
double visibility(const RayScene& rays, const Position& point, const Sun& sun) {
    const glm::vec3 origin = point.position + point.face * (4 * rays.triangle_offset(point.triangle));
    const glm::vec3 side = glm::normalize(glm::cross(sun.towards, glm::vec3(0.3f, 0.2f, 0.93f))),
                    up = glm::cross(side, sun.towards);
    constexpr int kRays = 64;
    int open = 0;
    for (int i = 0; i < kRays; ++i) {
        const double radius = std::tan(sun.half_angle) * std::sqrt((i + 0.5) / kRays), angle = 2.4 * i;
        open += !rays.occluded({origin, sun.towards + static_cast<float>(radius * std::cos(angle)) * side +
                                            static_cast<float>(radius * std::sin(angle)) * up});
    }
    return static_cast<double>(open) / kRays;
}

TEST_F(SunShadowPictures, PlanesFollowLambertsLaw) {
    const glm::vec3 base(0.8f, 0.5f, 0.2f), irradiance(3, 2, 1);
    const Scene floor = test::painted(test::SceneBuilder().floor({0, 0, 0}, 20, 3).build(), base);
    for (const double elevation : {88.0, 45.0, 10.0, 2.0})
        for (const double half_angle : {0.0, 0.005, 0.1}) {
            const Sun sun{from(30, elevation), irradiance, half_angle};
            const Image image = lit(floor, sun, {.position = {0, 2, 6}, .target = {0, 0, 0}});
            for (int y = 60; y < kDown; ++y) // below the horizon
                for (int x = 0; x < kAcross; ++x)
                    for (int c = 0; c < 3; ++c) {
                        const double expected = static_cast<double>(base[c] * irradiance[c]) / kHalfTurn *
                                                std::sin(elevation * kHalfTurn / 180);
                        ASSERT_NEAR(static_cast<double>(image.at(x, y)[c]), expected, 1e-5 * expected)
                            << x << " " << y << " " << elevation << " " << half_angle;
                    }
        }
}

TEST_F(SunShadowPictures, SunsBelowThePlaneAreBlack) {
    const Scene floor = test::SceneBuilder().floor({0, 0, 0}, 20, 3).build();
    const Image image =
        lit(floor, {from(30, -5), glm::vec3(1), 0.005}, {.position = {0, 2, 6}, .target = {0, 0, 0}});
    for (const glm::vec3& pixel : image.pixels)
        ASSERT_EQ(pixel, glm::vec3(0));
}

/// Spheres over each other and over a floor, a thin upright sheet, and a wall on the floor.
Scene playground() {
    return test::join(
        {test::SceneBuilder().floor({0, 0, 0}, 6, 6).build(),
         test::SceneBuilder().sphere({0, 0.9f, 0}, 0.6f, 24).build(),
         test::SceneBuilder().sphere({0.9f, 2.2f, 0.3f}, 0.3f, 16).build(),
         test::painted(test::SceneBuilder()
                           .quad({-1.5f, 0, 1}, {-0.9f, 0, 1}, {-0.9f, 1.5f, 1}, {-1.5f, 1.5f, 1})
                           .build(),
                       glm::vec3(1), true),
         test::SceneBuilder().quad({1.4f, 0, -2}, {1.4f, 0, 2}, {1.4f, 1.2f, 2}, {1.4f, 1.2f, -2}).build()});
}

struct Agreement {
    double compared = 0, wrong = 0, error = 0;
};

/// If the sun is fully visible or fully hidden around a pixel, the picture must agree.
Agreement agreement(const Image& image, const Scene& scene, const Sun& sun, const Camera& camera) {
    const RayScene rays(scene);
    Agreement result;
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) {
            double least = 1, most = 0;
            std::optional<Position> middle;
            bool inside = true;
            for (const glm::dvec2 d : {glm::dvec2(0.5), {0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
                const auto point = seen_at(rays, scene, camera, x + d.x, y + d.y);
                inside = inside && point && glm::dot(point->face, sun.towards) > 0.05f &&
                         (!middle || point->triangle == middle->triangle);
                if (!inside)
                    break;
                middle = middle ? middle : point;
                const double v = visibility(rays, *point, sun);
                least = std::min(least, v);
                most = std::max(most, v);
            }
            if (!inside || most - least > 0)
                continue;
            // The normal is interpolated: only whether light arrives is compared.
            const bool lit =
                image.at(x, y).r > 0.5f * sun.irradiance.r / 3.14f * glm::dot(middle->face, sun.towards);
            result.compared += 1;
            result.wrong += lit != (most > 0.5);
        }
    return result;
}

TEST_F(SunShadowPictures, AgreeWithRaysAwayFromPenumbrae) {
    const Scene scene = playground();
    const Camera camera{.position = {2, 3.5f, 6}, .target = {0, 0.7f, 0}};
    for (const double elevation : {70.0, 35.0, 12.0})
        for (const double half_angle : {0.0, 0.0047, 0.03}) {
            const Sun sun{from(-40, elevation), glm::vec3(1), half_angle};
            const Agreement a = agreement(lit(scene, sun, camera), scene, sun, camera);
            EXPECT_GT(a.compared, 5000) << elevation << " " << half_angle;
            EXPECT_LE(a.wrong, 0.0005 * a.compared) << elevation << " " << half_angle;
        }
}

TEST_F(SunShadowPictures, FromInsideTheSceneAgreeWithRays) {
    const Scene scene = playground();
    const Camera camera{.position = {-0.6f, 0.4f, 2.5f}, .target = {0, 0.5f, 0}};
    const Sun sun{from(140, 40), glm::vec3(1), 0.0047};
    const Agreement a = agreement(lit(scene, sun, camera), scene, sun, camera);
    EXPECT_GT(a.compared, 3000);
    EXPECT_LE(a.wrong, 0.0005 * a.compared);
}

TEST_F(SunShadowPictures, TwoSunsAdd) {
    const Scene scene = playground();
    const Camera camera{.position = {2, 3.5f, 6}, .target = {0, 0.7f, 0}};
    const Sun suns[2] = {{from(-40, 50), {1, 0.5f, 0.25f}, 0.004}, {from(70, 30), {0.25f, 0.5f, 1}, 0.01}};
    const Image both = lit(scene, suns, camera), first = lit(scene, suns[0], camera),
                second = lit(scene, suns[1], camera);
    double sum = 0, difference = 0;
    for (std::size_t i = 0; i < both.pixels.size(); ++i) {
        sum += static_cast<double>(glm::length(both.pixels[i]));
        difference += static_cast<double>(glm::distance(both.pixels[i], first.pixels[i] + second.pixels[i]));
    }
    EXPECT_GT(sum, 100);
    EXPECT_LE(difference, 1e-3 * sum); // map sizes are the larger of the two required sizes
}

/// A roof over the half x > 0 of a floor, at height 1, below a sun at the zenith: at x the straight edge cuts
/// the disc at t = x / tan(half angle) of its radius, and 1/2 - (t sqrt(1 - t²) + asin t) / pi of it is
/// visible.
TEST_F(SunShadowPictures, HaveThePenumbraOfAStraightEdge) {
    const double half_angle = 0.2;
    Scene roof = test::SceneBuilder().floor({4, 1, 0}, 4, 1).build();
    const Scene scene = test::join({test::SceneBuilder().floor({0, 0, 0}, 4, 1).build(), roof});
    // From under the roof, whose front faces up.
    const Camera camera{.position = {0, 0.9f, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}};
    const Image image = lit(scene, {{0, 1, 0}, glm::vec3(static_cast<float>(kHalfTurn)), half_angle}, camera);
    const CameraFrame frame = camera_frame(camera);
    double worst = 0;
    for (int x = 0; x < kAcross; ++x) {
        const double at = 0.9 * view_direction(frame, kAcross, kDown, x + 0.5, 0).x,
                     t = std::clamp(at / std::tan(half_angle), -1.0, 1.0);
        const double open = 0.5 - (t * std::sqrt(1 - t * t) + std::asin(t)) / kHalfTurn;
        double mean = 0; // over the patterns of the filter
        for (int y = 0; y < kDown; ++y)
            mean += static_cast<double>(image.at(x, y).r) / kDown;
        worst = std::max(worst, std::abs(mean - open));
    }
    // A blocker near the rim of the cone may be missed by the 24 sampled texels.
    EXPECT_LT(worst, 0.03);
}

/// A floor below the scene `above`, seen from the side and lit from the zenith by irradiance pi: returns the
/// fraction that arrives in the middle.
class BelowTheZenith : public SunShadowPictures {
protected:
    double through(const Scene& above, std::span<const Texture> textures = {}) const {
        const Scene scene = test::join({test::SceneBuilder().floor({0, 0, 0}, 1, 1).build(), above});
        const Sun sun{{0, 1, 0}, glm::vec3(static_cast<float>(kHalfTurn)), 0.005};
        const Camera camera{.position = {0, 0.3f, 1}, .target = {0, 0, 0}};
        const Image image = lit(scene, std::span(&sun, 1), camera, textures);
        double mean = 0;
        for (int y = 50; y < 70; ++y)
            for (int x = 60; x < 100; ++x)
                mean += static_cast<double>(image.at(x, y).g) / (20 * 40);
        return mean;
    }
    static Scene pane(float height) { return test::SceneBuilder().floor({0, height, 0}, 2, 1).build(); }
    static Scene blended(float height, float alpha) {
        Scene scene = pane(height);
        scene.materials[0].alpha_mode = AlphaMode::blend;
        scene.materials[0].base_color.a = alpha;
        return scene;
    }
};

TEST_F(BelowTheZenith, IsDarkUnderOpaqueSurfaces) {
    EXPECT_EQ(through(pane(1)), 0);
    EXPECT_EQ(through(test::SceneBuilder() // its back faces the sun
                          .quad({-2, 1, -2}, {2, 1, -2}, {2, 1, 2}, {-2, 1, 2})
                          .build()),
              0);
}

TEST_F(BelowTheZenith, IsOpenUnderSurfacesWithoutShadow) {
    Scene shell = pane(1);
    shell.materials[0].casts_shadow = false;
    EXPECT_NEAR(through(shell), 1, 1e-5);
}

TEST_F(BelowTheZenith, IsDimmedByAllBlendedLayersAndGlassTogether) {
    EXPECT_NEAR(through(blended(1, 0.25f)), 0.75, 1e-3); // half precision
    EXPECT_NEAR(through(test::join({blended(1, 0.25f), blended(2, 0.6f)})), 0.3, 1e-3);
    EXPECT_EQ(through(test::join({blended(1, 0.25f), pane(2)})), 0);
    Scene glass = pane(1);
    glass.materials[0].glass.factor = 0.8f;
    glass.materials[0].base_color = {0.5f, 0.5f, 0.5f, 1};
    EXPECT_NEAR(through(glass), 0.4, 1e-3);
    EXPECT_NEAR(through(test::with_opposites(glass)), 0.4, 1e-3);
}

TEST_F(BelowTheZenith, IsNotDimmedByItselfOrSurfacesBelow) {
    EXPECT_NEAR(through(blended(-1, 0.5f)), 1, 1e-5);
    // fully lit; half of the visible light comes from the floor, dimmed
    Scene glass_floor = blended(0.01f, 0.5f);
    EXPECT_NEAR(through(glass_floor), 0.5 + 0.5 * 0.5, 2e-3);
}

TEST_F(BelowTheZenith, ShowsCutOutsByTheirTexture) {
    Scene sheet = pane(1);
    sheet.vertex_arrays[0].texcoords.emplace_back();
    for (const glm::vec3& p : sheet.vertex_arrays[0].positions)
        sheet.vertex_arrays[0].texcoords[0].emplace_back(p.x, p.z);
    sheet.materials[0].alpha_mode = AlphaMode::mask;
    sheet.materials[0].base_color_texture.image = 0;
    const std::vector<Texture> open(1, make_texture({1, 1, {{255, 255, 255, 100}}})),
        closed(1, make_texture({1, 1, {{255, 255, 255, 200}}}));
    EXPECT_NEAR(through(sheet, open), 1, 1e-5);
    EXPECT_EQ(through(sheet, closed), 0);
}

TEST_F(SunShadowPictures, ShowTransmittingSheetsButNoMedia) {
    Scene sheet =
        test::painted(test::SceneBuilder().quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}).build(),
                      {0.5f, 0.4f, 0.3f}, true);
    Material& material = sheet.materials[0];
    material.transmission.factor = 0.25f;
    material.transmission.color = {0.2f, 0.8f, 0.4f};
    const Camera camera{.position = {0, 0, 2}, .target = {0, 0, 0}};
    const double cosine = std::cos(0.5);
    const glm::vec3 slant(static_cast<float>(std::sin(0.5)), 0, static_cast<float>(cosine));
    const auto middle = [&](const glm::vec3& towards) {
        return lit(sheet, {towards, glm::vec3(static_cast<float>(kHalfTurn)), 0.005}, camera)
            .at(kAcross / 2, kDown / 2);
    };
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(static_cast<double>(middle(slant)[c]),
                    0.75 * static_cast<double>(material.base_color[c]) * cosine, 1e-5);
        EXPECT_NEAR(static_cast<double>(middle(-slant)[c]),
                    0.25 * static_cast<double>(material.transmission.color[c]) * cosine, 1e-5);
    }
    material.volume = {.thickness = 1, .attenuation_distance = 1, .attenuation_color = glm::vec3(0.5f)};
    EXPECT_EQ(middle(slant), glm::vec3(0));
    EXPECT_EQ(middle(-slant), glm::vec3(0));
}

TEST_F(SunShadowPictures, MoreSunsThanMapsAreRejected) {
    const Scene floor = test::SceneBuilder().floor({0, 0, 0}, 1, 1).build();
    const std::vector<Sun> suns(kMaxShadowedSuns + 1, {{0, 1, 0}, glm::vec3(1), 0});
    EXPECT_THROW(lit(floor, suns, {.position = {0, 1, 2}, .target = {0, 0, 0}}), Error);
}

} // namespace
} // namespace prt

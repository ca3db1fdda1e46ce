// Tests the direct term separate from the indirect one: the content of each, and that their sum is complete.

#include "prt/bake/bake.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>

namespace prt {
namespace {

/// A floor of this color under a white ball.
Scene ball_over(const glm::vec3& floor) {
    return test::join(
        {test::painted(test::SceneBuilder().floor({0, 0, 0}, 2, 8).build(), floor),
         test::painted(test::SceneBuilder().sphere({0, 0.8f, 0}, 0.5f, 10).build(), glm::vec3(1))});
}

Transfer terms_of(const Scene& scene, int bounces, const SubsurfaceOptions& media = {}, bool denoise = true) {
    BakeOptions options;
    options.order = 3;
    options.rays = 256;
    options.bounces = bounces;
    options.subsurface = media;
    options.repairs.denoise = denoise;
    options.memory.storage = TransferStorage::float32;
    options.tracer.backend = Backend::cpu;
    return bake(scene, options).baked.transfer;
}

std::vector<TermKind> kinds_of(const Transfer& transfer) {
    std::vector<TermKind> kinds;
    for (const TransferTerm& term : transfer.layout.terms)
        kinds.push_back(term.kind);
    return kinds;
}

const std::vector<TermKind> kDirectAlone = {TermKind::direct}, kBoth = {TermKind::direct, TermKind::indirect};

TEST(BakedTerms, FollowTheSceneContent) {
    const Scene grey = ball_over(glm::vec3(0.5f)), red = ball_over({0.9f, 0.2f, 0.1f});
    EXPECT_EQ(kinds_of(terms_of(grey, 0)), kDirectAlone);
    const Transfer bounced = terms_of(grey, 1), colored = terms_of(red, 1);
    EXPECT_EQ(kinds_of(bounced), kBoth);
    EXPECT_EQ(bounced.layout.dimension(), 18u);
    EXPECT_EQ(kinds_of(colored), kBoth);
    EXPECT_EQ(colored.layout.terms[0].channels, 1);
    EXPECT_EQ(colored.layout.terms[1].channels, 3);
    // There is no other surface for light to bounce off.
    EXPECT_EQ(kinds_of(terms_of(test::SceneBuilder().floor({0, 0, 0}, 2, 4).build(), 2)), kDirectAlone);
}

/// Bounces follow one ray in four, while direct light uses all rays: they are equal to those of a bake
/// without bounces.
TEST(BakedTerms, DirectLightEqualsABakeWithoutBounces) {
    const Scene scene = ball_over({0.9f, 0.2f, 0.1f});
    // The filter looks at all light.
    const Transfer direct = terms_of(scene, 0, {}, false);
    for (const int bounces : {1, kEndlessBounces}) {
        const Transfer both = terms_of(scene, bounces, {}, false);
        ASSERT_EQ(kinds_of(both), kBoth);
        float largest = 0;
        for (std::size_t p = 0; p < direct.receivers(); ++p)
            for (std::size_t i = 0; i < 9; ++i)
                largest = std::max(largest, std::abs(direct.vector(p)[i] - both.vector(p)[i]));
        EXPECT_LT(largest, 1e-6f) << bounces;
    }
}

/// A closed white box with a hole: all incoming light spreads until R is 1, independent of the first hit.
TEST(BakedTerms, SumToTheSkyInAFurnace) {
    const Transfer both = terms_of(
        test::painted(test::SceneBuilder().bowl({0, 0, 0}, 1, 12, 3).build(), glm::vec3(1)), kEndlessBounces);
    ASSERT_EQ(kinds_of(both), kBoth);
    const Light white = constant_light(3, glm::vec3(1)), black = constant_light(3, glm::vec3(0));
    const auto lit = exit_radiance(both, Lighting{white}),
               after_bounces = exit_radiance(both, Lighting{black, white}),
               direct = exit_radiance(both, Lighting{white, constant_light(3, glm::vec3(-1))});
    float darkest = 1, brightest = 0;
    for (std::size_t p = 0; p < lit.size(); ++p)
        if (lit[p].x > 0) { // on a surface
            EXPECT_NEAR(lit[p].x, 1, 1e-4f) << p;
            EXPECT_NEAR(direct[p].x + after_bounces[p].x, 1, 1e-4f) << p;
            darkest = std::min(darkest, direct[p].x);
            brightest = std::max(brightest, direct[p].x);
        }
    EXPECT_LT(darkest, 0.3f);
    EXPECT_LT(brightest, 0.9f);
}

/// Half of the light on the front of a thin leaf comes from behind and is red: direct light has three
/// channels.
TEST(BakedTerms, DirectLightHasTheColorOfTransmittingSheets) {
    Scene leaf = test::painted(test::SceneBuilder().floor({0, 0, 0}, 1, 2).build(), {0.8f, 0.4f, 0.2f}, true);
    leaf.materials[0].transmission.factor = 0.5f;
    leaf.materials[0].transmission.color = {0.5f, 1, 1};
    const Transfer direct = terms_of(leaf, 0);
    EXPECT_EQ(kinds_of(direct), kDirectAlone);
    ASSERT_EQ(direct.layout.channels(), 3);
    // (1 - f) T_front + f c / rho T_back under uniform light: both sides are open.
    const auto lit = exit_radiance(direct, constant_light(3, glm::vec3(1)));
    const glm::vec3 expected = 0.5f + 0.5f * glm::vec3(0.5f / 0.8f, 1 / 0.4f, 1 / 0.2f);
    for (const glm::vec3& r : lit)
        EXPECT_LT(glm::distance(r, expected), 2e-3f);
}

/// All light of a medium has passed through it: none of it is direct, and objects next to it keep their
/// direct light.
TEST(BakedTerms, LightThroughMediaIsIndirect) {
    const Scene floor = test::painted(test::SceneBuilder().floor({0, 0, 0}, 2, 6).build(), glm::vec3(0.5f)),
                ball =
                    test::painted(test::SceneBuilder().sphere({0, 0.8f, 0}, 0.5f, 10).build(), glm::vec3(1));
    Scene scene = test::join({floor, ball});
    scene.materials[1].name = "milk";
    const Transfer both = terms_of(scene, 0, {.media = {{"milk", measured_media()[0].medium}}});
    ASSERT_EQ(kinds_of(both), kBoth);
    const std::size_t of_floor = floor.receivers();
    const auto is_dark = [](std::span<const float> term) {
        return std::all_of(term.begin(), term.end(), [](float v) { return v == 0; });
    };
    const std::vector<float> areas = receiver_areas(scene);
    for (std::size_t p = 0; p < both.receivers(); ++p) {
        if (areas[p] == 0) // on no surface
            continue;
        EXPECT_EQ(is_dark(both.vector(p).first(9)), p >= of_floor) << p;
        EXPECT_EQ(is_dark(both.vector(p).subspan(9)), p < of_floor) << p;
    }
    // A body alone has no direct light at all, and no part for it.
    Scene alone = ball;
    alone.materials[0].name = "milk";
    EXPECT_EQ(kinds_of(terms_of(alone, 0, {.media = {{"milk", measured_media()[0].medium}}})),
              std::vector<TermKind>{TermKind::indirect});
}

} // namespace
} // namespace prt

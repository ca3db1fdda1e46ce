// The light that spherical harmonics get against the light that rays meet.

#include "core/light_rig.h"

#include "prt/core/sh.h"
#include "prt/core/sh_basis.h"
#include "prt/image/image_file.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace viewer {
namespace {

constexpr int kOrder = 6;

/// Projects the light for path tracing: the environment of `distant_light`, and its suns as directional
/// lights.
prt::Light projected(const prt::DistantLight& light) {
    prt::Light sum = prt::project({light.environment(), prt::EnvironmentLayout::lat_long}, kOrder);
    for (const prt::Sun& sun : light.suns())
        sum = prt::sum(sum, prt::directional_light(kOrder, sun.towards, sun.irradiance));
    return sum;
}

double relative_difference(const prt::Light& a, const prt::Light& b) {
    double difference = 0, norm = 0;
    for (std::size_t i = 0; i < a.coefficients.size(); ++i) {
        const glm::dvec3 d = glm::dvec3(a.coefficients[i]) - glm::dvec3(b.coefficients[i]);
        difference += glm::dot(d, d);
        norm += glm::dot(glm::dvec3(b.coefficients[i]), glm::dvec3(b.coefficients[i]));
    }
    return std::sqrt(difference / norm);
}

std::shared_ptr<LoadedEnvironment> gradient() {
    prt::Image image{64, 32, {}};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            image.pixels.emplace_back(1 + std::cos(0.1f * static_cast<float>(x)),
                                      2 - static_cast<float>(y) / 32, 0.5f);
    auto environment = std::make_shared<LoadedEnvironment>();
    environment->lat_long = image;
    environment->light = prt::project({image, prt::EnvironmentLayout::lat_long}, prt::kMaxOrder);
    environment->sky = environment->light;
    environment->mean = 1;
    return environment;
}

class RigLights : public testing::TestWithParam<LightKind> {};

TEST_P(RigLights, AreTheSameForHarmonicsAndRays) {
    LightRig rig;
    rig.set_environment(gradient());
    LightSettings settings = rig.settings();
    settings.window = prt::Window::none; // rays have no bands
    settings.lights = {make_light(GetParam())};
    settings.lights[0].direction = glm::normalize(glm::vec3(1, 0.4f, -0.7f));
    rig.set(settings);
    // The image of 1024 x 512 resolves the rim of a cone to half a degree of its twenty and more.
    EXPECT_LT(relative_difference(rig.light(kOrder), projected(rig.distant_light())), 0.005);
    settings.environment_on = false;
    rig.set(settings);
    EXPECT_LT(relative_difference(rig.light(kOrder), projected(rig.distant_light())), 0.01);
    settings.lights[0].on = false;
    rig.set(settings);
    for (const glm::vec3& c : rig.light(kOrder).coefficients)
        EXPECT_EQ(c, glm::vec3(0));
}

INSTANTIATE_TEST_SUITE_P(All, RigLights,
                         testing::Values(LightKind::sun, LightKind::cone, LightKind::sphere,
                                         LightKind::hemisphere));

TEST(LightRig, RotatesTheEnvironmentForBandsAndRays) {
    LightRig rig;
    rig.set_environment(gradient());
    LightSettings settings = rig.settings();
    settings.window = prt::Window::none;
    settings.rotation = 1.1f;
    rig.set(settings);
    EXPECT_LT(relative_difference(rig.light(kOrder), projected(rig.distant_light())), 0.005);
    settings.rotation = 0;
    const prt::Light rotated = rig.light(kOrder);
    rig.set(settings);
    EXPECT_GT(relative_difference(rig.light(kOrder), rotated), 0.05);
}

TEST(LightRig, SunRisesInTheEastAndIsSouthAtNoon) {
    LightRig rig;
    LightSettings settings = rig.settings();
    settings.day = true;
    settings.window = prt::Window::none;
    const auto sun = [&](double hour) {
        settings.time.hour = hour;
        rig.set(settings);
        EXPECT_LT(relative_difference(rig.light(kOrder), projected(rig.distant_light())), 0.005) << hour;
        const auto suns = rig.distant_light().suns();
        return suns.empty() ? glm::vec3(0) : suns[0].towards;
    };
    EXPECT_NEAR(sun(12).z, std::sqrt(0.5f), 1e-6f); // +Z is south
    EXPECT_NEAR(sun(12).y, std::sqrt(0.5f), 1e-6f);
    EXPECT_GT(sun(7).x, 0.9f); // looking south, east is on the left
    EXPECT_LT(sun(17).x, -0.9f);
    EXPECT_EQ(sun(0), glm::vec3(0)); // night
}

TEST(LightRig, TheSunOfTheDayIsHalfADegreeAcross) {
    LightRig rig;
    const SeparateLight separate = rig.separate_light(kOrder);
    ASSERT_EQ(separate.suns.size(), 1U);
    EXPECT_NEAR(separate.suns[0].half_angle, 0.265 * std::numbers::pi / 180, 1e-12);
}

TEST(LightRig, NightIsBlueAndDarkerThanDusk) {
    LightRig rig;
    LightSettings settings = rig.settings();
    const auto mean = [&](double hour) {
        settings.time.hour = hour;
        rig.set(settings);
        return 0.2820948f * rig.light(kOrder).coefficients[0]; // mean radiance over all directions
    };
    glm::vec3 last = mean(17.5);
    EXPECT_EQ(rig.darkness(), 0);
    for (const double hour : {18.0, 18.25, 18.5, 18.75}) { // the sun has set
        const glm::vec3 now = mean(hour);
        EXPECT_LT(now.g, last.g) << hour;
        last = now;
    }
    EXPECT_GT(rig.darkness(), 0.5f);
    const glm::vec3 night = mean(21);
    EXPECT_EQ(rig.darkness(), 1);
    EXPECT_LT(night.g, last.g);
    EXPECT_EQ(mean(0), night);
    EXPECT_EQ(mean(4), night);
    EXPECT_LT(night.g, 0.005f * mean(18).g);
    EXPECT_GT(night.g, 0);
    EXPECT_GT(night.b, 1.5f * night.r);
    settings.day = false; // an environment map is as it is
    rig.set(settings);
    EXPECT_EQ(rig.darkness(), 0);
}

/// Returns the minimum radiance of any channel on a grid of two degrees, over the mean of the channel.
float min_over_mean(const prt::Light& light) {
    std::vector<float> basis(static_cast<std::size_t>(prt::coefficient_count(light.order)));
    float least = std::numeric_limits<float>::infinity();
    for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 180; ++x) {
            prt::evaluate_sh(light.order, glm::vec3(prt::lat_long_direction(180, 90, x + 0.5, y + 0.5)),
                             basis);
            glm::vec3 sum(0);
            for (std::size_t i = 0; i < basis.size(); ++i)
                sum += basis[i] * light.coefficients[i];
            const glm::vec3 share = sum / (0.2820948f * light.coefficients[0]);
            least = std::min({least, share.r, share.g, share.b});
        }
    return least;
}

TEST(LightRig, LightIsNonnegativeWithTheDefaultWindow) {
    LightRig rig; // a clear day
    LightSettings settings = rig.settings();
    for (const bool with_sun : {false, true}) {
        if (with_sun)
            settings.lights = {make_light(LightKind::sun)};
        settings.rotation = with_sun ? 0.8f : 0.0f;
        settings.window = prt::Window::automatic;
        rig.set(settings);
        for (const int order : {3, 6, 10})
            EXPECT_GT(min_over_mean(rig.light(order)), -1e-4f) << order;
        settings.window = prt::Window::none;
        rig.set(settings);
        EXPECT_LT(min_over_mean(rig.light(6)), -0.1f);
    }
    EXPECT_EQ(LightRig().settings().window, prt::Window::automatic);
}

prt::Light together(const SeparateLight& separate) {
    return prt::sum(separate.lighting.sky, *separate.lighting.suns);
}

TEST(LightRig, SeparateLightSumsToTheCombinedLight) {
    LightRig rig; // a clear day with its sun
    LightSettings settings = rig.settings();
    settings.window = prt::Window::none;
    settings.rotation = 0.7f;
    settings.lights = {make_light(LightKind::cone), make_light(LightKind::sun)};
    settings.lights[1].direction = {1, 0, 0};
    rig.set(settings);
    const SeparateLight separate = rig.separate_light(kOrder);
    ASSERT_EQ(separate.suns.size(), 2U);
    EXPECT_LT(relative_difference(together(separate), rig.light(kOrder)), 1e-6);
    const auto rays = rig.distant_light().suns();
    for (const prt::Sun& sun : rays) // path tracing uses the same suns
        EXPECT_TRUE(std::ranges::any_of(separate.suns, [&](const prt::Sun& disc) {
            return disc.towards == sun.towards && disc.irradiance == sun.irradiance;
        }));
    settings.lights[1].on = false;
    rig.set(settings);
    EXPECT_EQ(rig.separate_light(kOrder).suns.size(), 1U);
}

TEST(LightRig, SeparatesOnlyTheStrongestSuns) {
    LightRig rig;
    LightSettings settings = rig.settings();
    settings.day = settings.environment_on = false;
    settings.window = prt::Window::none;
    for (const float strength : {1.0f, 5.0f, 2.0f, 4.0f, 3.0f}) {
        settings.lights.push_back(make_light(LightKind::sun));
        settings.lights.back().strength = strength;
        settings.lights.back().color = glm::vec3(1);
    }
    rig.set(settings);
    const SeparateLight separate = rig.separate_light(kOrder);
    ASSERT_EQ(separate.suns.size(), 4U);
    EXPECT_NEAR(separate.suns.front().irradiance.r, 5 * std::numbers::pi_v<float>, 1e-4f);
    EXPECT_NEAR(separate.suns.back().irradiance.r, 2 * std::numbers::pi_v<float>, 1e-4f);
    EXPECT_LT(relative_difference(together(separate), rig.light(kOrder)), 1e-6);
}

TEST(LightRig, FindsAndRotatesTheSunsOfAnEnvironment) {
    const prt::test::TemporaryFolder folder;
    prt::Image image{256, 128, std::vector<glm::vec3>(std::size_t{256} * 128, glm::vec3(1))};
    const glm::dvec3 at = prt::lat_long_direction(256, 128, 100.5, 40.5);
    image.at(100, 40) = glm::vec3(2e4f);
    prt::write_exr(folder / "sun.exr", image, prt::EnvironmentLayout::lat_long);
    LightRig rig;
    rig.set_environment(std::make_shared<LoadedEnvironment>(load_environment((folder / "sun.exr").string())));
    LightSettings settings = rig.settings();
    settings.window = prt::Window::none;
    rig.set(settings);
    const SeparateLight separate = rig.separate_light(kOrder);
    ASSERT_EQ(separate.suns.size(), 1U);
    EXPECT_GT(glm::dot(glm::dvec3(separate.suns[0].towards), at), std::cos(0.01)); // a texel is 0.025 wide
    EXPECT_NEAR(together(separate).coefficients[0].g / rig.light(kOrder).coefficients[0].g, 1, 1e-3);
    EXPECT_LT(relative_difference(separate.lighting.sky, prt::constant_light(kOrder, glm::vec3(1))), 0.01);
    EXPECT_TRUE(rig.distant_light().suns().empty()); // rays meet it in the image
    const prt::ReferenceLight measured = rig.separate_reference_light();
    EXPECT_LT(relative_difference(projected(*measured.sky), prt::constant_light(kOrder, glm::vec3(1))), 0.01);
    settings.rotation = 1;
    rig.set(settings);
    EXPECT_LT(glm::distance(rig.separate_light(kOrder).suns[0].towards,
                            glm::vec3(glm::rotate(glm::dmat4(1), 1.0, glm::dvec3(0, 1, 0)) *
                                      glm::dvec4(glm::dvec3(separate.suns[0].towards), 0))),
              1e-5f);
}

TEST(LightRig, MeasuresBandsAndRaysOfTheSameLight) {
    LightRig rig;
    LightSettings settings = rig.settings(); // a day with its sun
    settings.window = prt::Window::hann;     // does not affect bands and rays
    settings.rotation = 1;
    settings.lights.assign(6, make_light(LightKind::sun)); // more than the maximum number of separate suns
    settings.lights.push_back(make_light(LightKind::hemisphere));
    for (std::size_t i = 0; i < 6; ++i)
        settings.lights[i].direction = glm::normalize(glm::vec3(std::cos(i), 0.5f, std::sin(i)));
    rig.set(settings);
    const auto bands = [](const prt::Light& light) { return prt::truncated(light, kOrder); };
    const prt::ReferenceLight together = rig.reference_light(), separate = rig.separate_reference_light();
    // The day's image of 128 x 64 is rotated in one of 1024 x 512 with interpolation; its sun has an extent
    // that rays do not hit.
    constexpr double kRotated = 0.01;
    EXPECT_FALSE(together.sky);
    EXPECT_LT(relative_difference(bands(together.sky_bands), projected(together.all)), kRotated);
    ASSERT_TRUE(separate.sky);
    EXPECT_EQ(separate.suns.size(), 4U);
    EXPECT_EQ(separate.sky->suns().size(), 3U);
    EXPECT_LT(relative_difference(bands(separate.sky_bands), projected(*separate.sky)), kRotated);
    EXPECT_LT(relative_difference(prt::sum(bands(separate.sky_bands), bands(separate.sun_bands)),
                                  projected(separate.all)),
              kRotated);
}

TEST(LightRig, CountsItsChanges) {
    LightRig rig;
    const auto version = rig.version();
    rig.set(rig.settings());
    EXPECT_EQ(rig.version(), version);
    LightSettings settings = rig.settings();
    settings.rotation = 0.5f;
    const auto background = rig.background_version();
    rig.set(settings);
    EXPECT_GT(rig.version(), version);
    EXPECT_EQ(rig.background_version(), background); // the shader rotates it
    settings.time.hour += 1;
    rig.set(settings);
    EXPECT_GT(rig.background_version(), background);
    EXPECT_TRUE(rig.background());
    settings.day = settings.environment_on = false;
    const auto day = rig.background_version();
    rig.set(settings);
    EXPECT_GT(rig.background_version(), day);
    EXPECT_FALSE(rig.background());
}

} // namespace
} // namespace viewer

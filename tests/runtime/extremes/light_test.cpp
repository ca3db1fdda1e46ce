// Tests that every function that makes or changes lighting returns finite coefficients or throws.

#include "prt/core/dering.h"
#include "prt/core/light.h"
#include "prt/fit/suns.h"
#include "support/extremes.h"

namespace prt {
namespace {

using test::ExtremeCase;
using test::Numbers;
using test::numbers_of;

const glm::vec3 kUp(0, 1, 0), kWhite(1);

Numbers coefficients(const Light& light) {
    return numbers_of(light.coefficients);
}

/// Returns a light with this mean and this last coefficient, if there is one.
Light light_of(int order, float mean, float other) {
    Light light{order, std::vector<glm::vec3>(static_cast<std::size_t>(order * order), glm::vec3(0.1f))};
    light.coefficients[0] = {mean, 1, 1};
    light.coefficients.back() = {other, other, 0};
    return light;
}

std::array<glm::vec3, 9> nine(float x, float y) {
    std::array<glm::vec3, 9> colors;
    colors.fill({x, y, 1});
    return colors;
}

const ExtremeCase kMakers[] = {
    {"constant",
     [](int n, float x, float y) {
         return coefficients(constant_light(n, {x, y, 1}));
     }},
    {"directional",
     [](int n, float x, float y) {
         return coefficients(directional_light(n, kUp, {x, y, 1}));
     }},
    {"directional_towards",
     [](int n, float x, float y) {
         return coefficients(directional_light(n, {x, y, 1}, kWhite));
     }},
    {"sun",
     [](int n, float x, float y) {
         return coefficients(as_light({{0, 1, 0}, {x, 1, 1}, static_cast<double>(y)}, n));
     }},
    {"cone",
     [](int n, float x, float y) {
         return coefficients(cone_light(n, kUp, x, {1, y, 1}));
     }},
    {"cone_axis",
     [](int n, float x, float y) {
         return coefficients(cone_light(n, {x, y, 0}, 1, kWhite));
     }},
    {"hemisphere",
     [](int n, float x, float y) {
         return coefficients(hemisphere_light(n, kUp, {x, 1, 1}, {y, 1, 1}));
     }},
    {"sphere",
     [](int n, float x, float y) {
         return coefficients(sphere_light(n, {0, 2, x}, y, kWhite));
     }},
    {"sphere_color",
     [](int n, float x, float y) {
         return coefficients(sphere_light(n, {0, 2, 0}, 1, {x, y, 1}));
     }},
    {"disc",
     [](int n, float x, float y) {
         return coefficients(disc_light(n, {1, 2, x}, -kUp, y, kWhite));
     }},
    {"disc_normal",
     [](int n, float x, float y) {
         return coefficients(disc_light(n, {0, 2, 0}, {x, y, 1}, 1, kWhite));
     }},
    {"disc_far",
     [](int n, float x, float y) {
         return coefficients(disc_light(n, {x, y, 1}, {0, 0, -1}, 1, kWhite));
     }},
    {"disc_color",
     [](int n, float x, float y) {
         return coefficients(disc_light(n, {0, 2, 0}, -kUp, 1, {x, y, 1}));
     }},
    {"overcast",
     [](int n, float x, float y) {
         return coefficients(overcast_sky(n, {x, y, 1}));
     }},
    {"sky",
     [](int n, float x, float y) {
         return coefficients(
             sky_light(n, PreethamSky(2 + static_cast<double>(x), {0, 1, static_cast<double>(y)})));
     }},
    {"scaled", [](int n, float x,
                  float y) { return coefficients(scaled_to_exit_radiance(light_of(n, x, y), kUp, kWhite)); }},
    {"scaled_to",
     [](int n, float x, float y) {
         return coefficients(scaled_to_exit_radiance(constant_light(n, kWhite), {0, 1, y}, {x, 1, 1}));
     }},
    {"d3dx_directional",
     [](int n, float x, float y) {
         return coefficients(d3dx_directional_light(n, {x, 1, 0}, {y, 1, 1}));
     }},
    {"d3dx_cone",
     [](int n, float x, float y) {
         return coefficients(d3dx_cone_light(n, kUp, x, {y, 1, 1}));
     }},
    {"d3dx_hemisphere",
     [](int n, float x, float y) {
         return coefficients(d3dx_hemisphere_light(n, kUp, {x, 1, 1}, {y, 1, 1}));
     }},
    {"from_three_js", [](int, float x, float y) { return coefficients(from_three_js(nine(x, y))); }},
    {"from_gltf_irradiance",
     [](int, float x, float y) { return coefficients(from_gltf_irradiance(nine(x, y))); }},
};

const ExtremeCase kChangers[] = {
    {"sum", [](int n, float x, float y) { return coefficients(sum(light_of(n, x, y), light_of(n, y, x))); }},
    {"blended",
     [](int n, float x, float y) { return coefficients(blended(light_of(n, x, 1), light_of(n, 1, x), y)); }},
    {"truncated", [](int n, float x, float y) { return coefficients(truncated(light_of(n, x, y), n)); }},
    {"rotated",
     [](int n, float x, float y) {
         return coefficients(rotated_about_y(light_of(n, x, 1), static_cast<double>(y)));
     }},
    {"hann", [](int n, float x, float y) { return coefficients(windowed(light_of(n, x, y), Window::hann)); }},
    {"lanczos",
     [](int n, float x, float y) { return coefficients(windowed(light_of(n, x, y), Window::lanczos)); }},
    {"deringed", [](int n, float x, float y) { return coefficients(deringed(light_of(n, x, y))); }},
    {"dering_factors",
     [](int n, float x, float y) {
         const BandFactors factors = dering_factors(light_of(n, x, y));
         return Numbers(factors.begin(), factors.end());
     }},
    {"with_band_factors",
     [](int n, float x, float y) {
         BandFactors factors;
         factors.fill(static_cast<double>(y));
         return coefficients(with_band_factors(light_of(n, x, 1), factors));
     }},
    {"to_three_js", [](int n, float x, float y) { return numbers_of(to_three_js(light_of(n, x, y))); }},
    {"to_gltf_irradiance",
     [](int n, float x, float y) { return numbers_of(to_gltf_irradiance(light_of(n, x, y))); }},
};

class MadeLight : public testing::TestWithParam<ExtremeCase> {};
INSTANTIATE_TEST_SUITE_P(Functions, MadeLight, testing::ValuesIn(kMakers), test::name_of);
TEST_P(MadeLight, IsFiniteOrRejected) {
    test::expect_finite_or_refused(GetParam());
}

class ChangedLight : public testing::TestWithParam<ExtremeCase> {};
INSTANTIATE_TEST_SUITE_P(Functions, ChangedLight, testing::ValuesIn(kChangers), test::name_of);
TEST_P(ChangedLight, IsFiniteOrRejected) {
    test::expect_finite_or_refused(GetParam());
}

} // namespace
} // namespace prt

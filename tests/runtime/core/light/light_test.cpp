// Tests lights of simple shapes against numerical integrals.

#include "prt/core/light.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "support/light_difference.h"
#include "support/quadrature.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace prt {
namespace {

using test::largest_difference;

using std::numbers::pi;

/// Largest coefficient error of `light` against integrals of `radiance`, red channel.
double largest_error(const Light& light, int cells,
                     const std::function<double(const glm::dvec3&)>& radiance) {
    double largest = 0;
    for (std::size_t i = 0; i < light.coefficients.size(); ++i) {
        const double integral = test::integrate_sphere(cells, [&](const glm::dvec3& w) {
            std::array<double, kMaxOrder * kMaxOrder> y{};
            const double l = radiance(w);
            if (l != 0)
                evaluate_sh(light.order, w, std::span<double>(y));
            return l * y[i];
        });
        largest = std::max(largest, std::abs(integral - static_cast<double>(light.coefficients[i].r)));
    }
    return largest;
}

TEST(Light, ConstantLightLightsAnOpenReceiverWithItsRadiance) {
    const Light light = constant_light(5, glm::vec3(1, 2, 3));
    std::array<double, 100> lobe{};
    clamped_cosine_lobe(5, {0, 0, 1}, lobe);
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        sum += lobe[i] * glm::dvec3(light.coefficients[i]);
    EXPECT_NEAR(sum.r, 1, 1e-6);
    EXPECT_NEAR(sum.g, 2, 1e-6);
    EXPECT_NEAR(sum.b, 3, 1e-6);
}

TEST(Light, ConeAgreesWithQuadrature) {
    const glm::vec3 axis = glm::normalize(glm::vec3(0.2f, 0.8f, -0.4f));
    const Light light = cone_light(5, axis, 0.7, glm::vec3(2));
    const double error = largest_error(light, 600, [&](const glm::dvec3& w) {
        return glm::dot(w, glm::dvec3(axis)) > std::cos(0.7) ? 2.0 : 0.0;
    });
    EXPECT_LT(error, 2e-3); // a cell is 2e-5 sr; about a thousand cells are on the rim
}

TEST(Light, FullSphereConeIsConstant) {
    const Light cone = cone_light(10, {0, 1, 0}, pi, glm::vec3(1)),
                constant = constant_light(10, glm::vec3(1));
    for (std::size_t i = 0; i < cone.coefficients.size(); ++i)
        EXPECT_NEAR(cone.coefficients[i].r, constant.coefficients[i].r, 1e-6f);
}

TEST(Light, OvercastSkyAgreesWithQuadrature) {
    const Light sky = overcast_sky(4, glm::vec3(3));
    const double error =
        largest_error(sky, 600, [](const glm::dvec3& w) { return w.y > 0 ? 1 + 2 * w.y : 0.0; });
    EXPECT_LT(error, 2e-3);
}

TEST(Light, DirectionalLightIlluminatesAFacingReceiver) {
    // Cut at ten bands the clamped cosine at its peak is the sum of A_l (2l+1) / (4 pi), with
    // A_l = pi (1, 2/3, 1/4, 0, -1/24, 0, 1/64, 0, -1/128): 1.4 % below the 1 of all bands.
    const double peak = (1 + 2 + 5 / 4.0 - 9 / 24.0 + 13 / 64.0 - 17 / 128.0) / 4;
    EXPECT_NEAR(peak, 1, 0.014);
    const glm::vec3 towards = glm::normalize(glm::vec3(1, 2, -1));
    const Light light = directional_light(10, towards, glm::vec3(5));
    std::array<double, 100> lobe{};
    clamped_cosine_lobe(10, glm::dvec3(towards), lobe);
    double sum = 0;
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        sum += lobe[i] * static_cast<double>(light.coefficients[i].r);
    EXPECT_NEAR(sum, 5 * peak / pi, 1e-6);
}

TEST(Light, QuarterRotationAboutYMovesLightFromZToX) {
    const Light from_z = cone_light(6, {0, 0, 1}, 0.3, glm::vec3(1)),
                from_x = cone_light(6, {1, 0, 0}, 0.3, glm::vec3(1));
    const Light rotated = rotated_about_y(from_z, pi / 2);
    for (std::size_t i = 0; i < rotated.coefficients.size(); ++i)
        EXPECT_NEAR(rotated.coefficients[i].r, from_x.coefficients[i].r, 1e-6f);
}

TEST(Light, WindowsLeaveTheMeanAndDampTheRest) {
    const Light light = directional_light(6, {0, 1, 0}, glm::vec3(1));
    for (const Window window : {Window::hann, Window::lanczos}) {
        const Light damped = windowed(light, window);
        EXPECT_FLOAT_EQ(damped.coefficients[0].r, light.coefficients[0].r);
        EXPECT_LT(std::abs(damped.coefficients[sh_index(5, -5)].r),
                  std::abs(light.coefficients[sh_index(5, -5)].r));
    }
}

float min_radiance(const Light& light) {
    float least = std::numeric_limits<float>::infinity();
    for (const auto& point : test::sphere_quadrature(40))
        least = std::min(least, radiance(light, glm::vec3(point.direction)).r);
    return least;
}

TEST(Light, AutomaticWindowChangesASunButNotASky) {
    const glm::vec3 towards = glm::normalize(glm::vec3(1, 1, 1));
    const Light sun = directional_light(6, towards, glm::vec3(1));
    EXPECT_LT(min_radiance(sun), -0.1f * radiance(sun, towards).r);
    const Light quiet = windowed(sun, Window::automatic);
    EXPECT_GT(min_radiance(quiet), -1e-3f * radiance(quiet, towards).r);
    EXPECT_GT(quiet.coefficients[2].r, 0.5f * sun.coefficients[2].r); // not more than is needed

    const Light sky = constant_light(6, glm::vec3(1));
    EXPECT_EQ(windowed(sky, Window::automatic).coefficients, sky.coefficients);
}

TEST(Light, ExtractingMissingBandsIsAnError) {
    EXPECT_THROW(truncated(constant_light(3, glm::vec3(1)), 4), Error);
    EXPECT_EQ(truncated(constant_light(4, glm::vec3(1)), 3).coefficients.size(), 9u);
}

TEST(Light, SphereEqualsItsCone) {
    const glm::vec3 center(1, 2, -2);
    EXPECT_LT(largest_difference(sphere_light(10, center, 1.5, {1, 2, 3}),
                                 cone_light(10, center / 3.0f, std::asin(0.5), {1, 2, 3})),
              1e-6);
    EXPECT_THROW(sphere_light(3, {0, 0, 1}, 1.5, {1, 1, 1}), Error);
    EXPECT_THROW(sphere_light(3, {0, 0, 1}, 0, {1, 1, 1}), Error);
    EXPECT_THROW(directional_light(3, {0, 0, 0}, {1, 1, 1}), Error);
}

TEST(Light, HemisphereBlendsFromTopToBottom) {
    const glm::vec3 up = glm::normalize(glm::vec3(1, 2, 3)), top(3, 2, 1), bottom(0.5f, 1, 0);
    const Light light = hemisphere_light(5, up, top, bottom);
    EXPECT_LT(glm::distance(radiance(light, up), top), 1e-5f);
    EXPECT_LT(glm::distance(radiance(light, -up), bottom), 1e-5f);
    const glm::vec3 side = glm::normalize(glm::cross(up, glm::vec3(0, 0, 1)));
    EXPECT_LT(glm::distance(radiance(light, side), 0.5f * (top + bottom)), 1e-5f);
}

/// Gauss-Legendre on [-1, 1], taken from that of the sphere in z.
std::pair<std::vector<double>, std::vector<double>> line_quadrature(int n) {
    std::vector<double> nodes, weights;
    for (const auto& point : test::sphere_quadrature(n)) {
        if (nodes.empty() || std::abs(point.direction.z - nodes.back()) > 1e-12) {
            nodes.push_back(point.direction.z);
            weights.push_back(0);
        }
        weights.back() += point.weight / (2 * pi);
    }
    return {nodes, weights};
}

/// Returns ∫ over the disc of Y(w) cos / distance², in polar coordinates on the disc: independent of the
/// integral along its rim.
std::vector<double> disc_by_area(int order, const glm::dvec3& center, const glm::dvec3& normal,
                                 double radius) {
    const glm::dvec3 u = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.5, -0.8))),
                     v = glm::cross(normal, u);
    std::vector<double> sum(static_cast<std::size_t>(coefficient_count(order)), 0), y(sum.size());
    constexpr int kAngles = 400;
    const auto [nodes, weights] = line_quadrature(60);
    for (std::size_t n = 0; n < nodes.size(); ++n)
        for (int a = 0; a < kAngles; ++a) {
            const double r = 0.5 * radius * (1 + nodes[n]), t = 2 * std::numbers::pi * a / kAngles;
            const glm::dvec3 p = center + r * (std::cos(t) * u + std::sin(t) * v), w = glm::normalize(p);
            const double area = weights[n] * 0.5 * radius * r * 2 * std::numbers::pi / kAngles;
            const double solid_angle = area * -glm::dot(normal, w) / glm::dot(p, p);
            evaluate_sh(order, w, std::span<double>(y));
            for (std::size_t i = 0; i < sum.size(); ++i)
                sum[i] += solid_angle * y[i];
        }
    return sum;
}

TEST(Light, DiscAgreesWithQuadratureOverItsArea) {
    for (const auto& [center, normal] : {std::pair(glm::vec3(0, 0, 2), glm::vec3(0, 0, -1)),
                                         std::pair(glm::vec3(1, 2, -1), glm::vec3(0.2f, -1, 0.4f)),
                                         std::pair(glm::vec3(3, 0.2f, 0), glm::vec3(-0.3f, 0, 0.95f))}) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(normal));
        const Light light = disc_light(10, center, normal, 1.2, {1, 1, 1});
        const auto expected = disc_by_area(10, glm::dvec3(center), n, 1.2);
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_NEAR(static_cast<double>(light.coefficients[i].r), expected[i], 1e-6) << i;
    }
}

TEST(Light, FacingDiscIsACone) {
    EXPECT_LT(largest_difference(disc_light(10, {0, 3, 0}, {0, -1, 0}, 3, {1, 2, 3}),
                                 cone_light(10, {0, 1, 0}, std::numbers::pi / 4, {1, 2, 3})),
              3e-6);
    // The largest disc covers half of the sphere.
    const Light wide = disc_light(4, {0, 0, 1e-3f}, {0, 0, -1}, 1000, {1, 1, 1});
    EXPECT_NEAR(wide.coefficients[0].r, 2 * std::numbers::pi * 0.2820948, 1e-5);
}

/// Off by `tilt` radians from the center's direction, to any side.
glm::vec3 tilted(const glm::vec3& center, double tilt, std::mt19937& random) {
    std::normal_distribution<double> gauss;
    const glm::dvec3 axis = glm::normalize(glm::dvec3(center)),
                     side = glm::normalize(
                         glm::cross(axis, glm::dvec3(gauss(random), gauss(random), gauss(random))));
    return glm::vec3(-std::cos(tilt) * axis + std::sin(tilt) * side);
}

/// To the rounding of their floats, which tilts them by some 1e-7.
TEST(Light, FacingDiscsAreConesFromAllDirections) {
    std::mt19937 random(7);
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> uniform;
    for (int i = 0; i < 3000; ++i) {
        const auto c = glm::vec3(std::pow(10, 4 * uniform(random) - 2) *
                                 glm::dvec3(gauss(random), gauss(random), gauss(random)));
        const double radius = std::pow(10, 3 * uniform(random) - 2);
        const std::array normals = {-c, -glm::normalize(c), -0.5f * c,
                                    tilted(c, std::pow(10, -15 + 9 * uniform(random)), random)};
        const Light cone = cone_light(6, c, std::atan(radius / glm::length(glm::dvec3(c))), glm::vec3(1));
        Light disc;
        ASSERT_NO_THROW(disc =
                            disc_light(6, c, normals[static_cast<std::size_t>(i % 4)], radius, glm::vec3(1)))
            << i;
        ASSERT_LE(largest_difference(disc, cone), 1e-5 * static_cast<double>(cone.coefficients[0].r)) << i;
    }
}

TEST(Light, NearlyFacingDiscsMatchQuadrature) {
    std::mt19937 random(7);
    for (const double tilt : {0.0, 1e-15, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3})
        for (const glm::vec3& c :
             {glm::vec3(1, 2, 3), glm::vec3(-1.50307615e-05f, .0128540518f, -.00432413304f)}) {
            const double radius = 1.5 * glm::length(glm::dvec3(c));
            const glm::vec3 normal = tilted(c, tilt, random);
            const Light disc = disc_light(6, c, normal, radius, glm::vec3(1));
            const auto expected = disc_by_area(6, glm::dvec3(c), glm::normalize(glm::dvec3(normal)), radius);
            for (std::size_t i = 0; i < expected.size(); ++i)
                EXPECT_NEAR(static_cast<double>(disc.coefficients[i].r), expected[i], 2e-6)
                    << tilt << ": " << i;
        }
    const glm::vec3 c(-1.50307615e-05f, .0128540518f, -.00432413304f);
    EXPECT_LT(
        largest_difference(disc_light(6, c, -c, .0522394, glm::vec3(1)),
                           cone_light(6, c, std::atan(.0522394 / glm::length(glm::dvec3(c))), glm::vec3(1))),
        1e-5);
}

TEST(Light, DiscIsDarkFromBehindAndRejectsInvalidInput) {
    for (const glm::vec3& c : disc_light(4, {0, 0, 2}, {0, 0, 1}, 1, {1, 1, 1}).coefficients)
        EXPECT_EQ(c, glm::vec3(0));
    EXPECT_THROW(disc_light(4, {0, 0, 2}, {0, 0, -1}, 0, {1, 1, 1}), Error);
    EXPECT_THROW(disc_light(4, {0, 0, 2}, {0, 0, 0}, 1, {1, 1, 1}), Error);
}

/// An independent integral that is accurate at the rim and in the plane of the disc: over rings about the
/// disc's normal, with the arc of each that the disc covers.
std::vector<double> disc_by_rings(int order, const glm::dvec3& center, const glm::dvec3& normal,
                                  double radius) {
    const double height = -glm::dot(normal, center);
    const glm::dvec3 lateral = center + height * normal;
    const double offset = glm::length(lateral);
    const glm::dvec3 u = offset > 0 ? lateral / offset : glm::dvec3(0, 0, 1), v = glm::cross(u, normal);
    std::vector<double> sum(static_cast<std::size_t>(coefficient_count(order)), 0), y(sum.size());
    const auto [nodes, weights] = line_quadrature(60);
    // Both ends of an interval may have the slope of a square root: s -> sin²(pi s / 2) removes it.
    const auto between = [&, &nodes = nodes, &weights = weights](double from, double to, std::size_t i) {
        const double s = 0.5 * (1 + nodes[i]);
        return std::pair(from + (to - from) * std::pow(std::sin(0.5 * pi * s), 2),
                         (to - from) * 0.5 * pi * std::sin(pi * s) * 0.5 * weights[i]);
    };
    const auto rings = [&, &nodes = nodes](double from, double to) {
        for (std::size_t r = 0; r < nodes.size(); ++r) {
            const auto [theta, ring] = between(from, to, r);
            const double distance = height * std::tan(theta);
            // Half the arc from the three sides of the triangle, without cancellation.
            const double a = radius - (distance - offset), b = radius + (distance - offset);
            const double half =
                distance + offset <= radius
                    ? pi
                    : 2 * std::asin(std::sqrt(std::clamp(a * b / (4 * distance * offset), 0.0, 1.0)));
            for (std::size_t k = 0; k < nodes.size(); ++k) {
                const auto [phi, arc] = between(-half, half, k);
                const glm::dvec3 w =
                    std::sin(theta) * (std::cos(phi) * u + std::sin(phi) * v) - std::cos(theta) * normal;
                evaluate_sh(order, w, std::span<double>(y));
                for (std::size_t i = 0; i < sum.size(); ++i)
                    sum[i] += ring * arc * std::sin(theta) * y[i];
            }
        }
    };
    const double nearest = std::atan2(std::abs(offset - radius), height),
                 farthest = std::atan2(offset + radius, height);
    if (offset < radius)
        rings(0, nearest);
    rings(nearest, farthest);
    return sum;
}

struct HardDisc {
    glm::vec3 center, normal;
    double radius;
};

TEST(Light, DiscsNextToTheRimGrazingAndFarAgreeWithRings) {
    const double tilt = 89.9 * pi / 180;
    for (const HardDisc& d :
         {HardDisc{{0.99f, 1e-6f, 0}, {0, -1, 0}, 1}, HardDisc{{1.01f, 1e-6f, 0}, {0, -1, 0}, 1},
          HardDisc{{3, 1e-3f, 0}, {0, -1, 0}, 1}, HardDisc{{0, 0, 10000}, {0, 0, -1}, 1},
          HardDisc{{0.3f, 1e-4f, 0.4f}, {0, -1, 0}, 1},
          HardDisc{{0, 0, 30}, glm::vec3(std::sin(tilt), 0, -std::cos(tilt)), 1},
          HardDisc{{2, 0.3f, 1}, {0, -1, 0}, 2},
          HardDisc{{1, 2, -1}, glm::normalize(glm::vec3(0.2f, -1, 0.4f)), 1.2}}) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(d.normal));
        const Light light = disc_light(10, d.center, d.normal, d.radius, {1, 1, 1});
        const auto expected = disc_by_rings(10, glm::dvec3(d.center), n, d.radius);
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_NEAR(static_cast<double>(light.coefficients[i].r), expected[i],
                        1e-5 * std::abs(expected[0]))
                << d.center.x << " " << d.center.y << " " << d.center.z << ": " << i;
    }
}

/// On the rim, just above the plane, one sees half of the half sphere.
TEST(Light, OnTheRimADiscCoversAQuarterOfTheSphere) {
    for (const float height : {1e-20f, 1e-12f, 1e-7f}) {
        const Light light = disc_light(3, {1, height, 0}, {0, -1, 0}, 1, {1, 1, 1});
        EXPECT_NEAR(static_cast<double>(light.coefficients[0].r), pi * 0.28209479,
                    2e-3 * std::sqrt(height / 1e-7f) + 1e-6);
    }
}

/// A cone that holds irradiance 1, however narrow, is a directional light.
TEST(Light, NarrowConesDoNotCancel) {
    const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, 3));
    const Light sun = directional_light(10, axis, glm::vec3(1));
    for (const double half_angle : {1e-5, 1e-6, 1e-8, 1e-12}) {
        const double radiance = 1 / (pi * std::pow(std::sin(half_angle), 2));
        EXPECT_LT(largest_difference(
                      cone_light(10, axis, half_angle, glm::vec3(static_cast<float>(radiance))), sun),
                  1e-6);
    }
}

TEST(Light, ConesWithoutAngleAreRejected) {
    for (const double half_angle : {-1.0, 4.0, 90.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(cone_light(3, {0, 1, 0}, half_angle, {1, 1, 1}), Error) << half_angle;
    EXPECT_NO_THROW(cone_light(3, {0, 1, 0}, static_cast<double>(static_cast<float>(pi)), {1, 1, 1}));
}

/// The values are those of D3DX's native tables and of DirectXMath.
TEST(ShConventions, LightsOfD3dxHaveItsNumbers) {
    for (const int order : {2, 3, 6})
        EXPECT_NEAR(d3dx_cone_light(order, {0, 0, 1}, 0.5, {1.7f, 0, 0}).coefficients[0].r, 1.604815f, 2e-6f);
    EXPECT_NEAR(d3dx_hemisphere_light(3, {0, 1, 0}, glm::vec3(0.1f), glm::vec3(8.71f)).coefficients[0].r,
                23.422981f, 1e-5f);
    const glm::vec3 n = glm::normalize(glm::vec3(1, 2, 3));
    EXPECT_LT(
        largest_difference(d3dx_directional_light(3, n, {1, 2, 0}),
                           directional_light(3, n, glm::vec3(1, 2, 0) * static_cast<float>(pi * 16 / 17))),
        1e-6); // 1/4 + 1/2 + 5/16 of three bands
    EXPECT_THROW(d3dx_cone_light(3, n, 0, {1, 1, 1}), Error);
}

TEST(Light, ScaledLightHasTheRequestedExitRadiance) {
    for (int order = 2; order <= 10; ++order) {
        const glm::vec3 n = glm::normalize(glm::vec3(1, 2, 3));
        const Light light = scaled_to_exit_radiance(directional_light(order, n, {1, 1, 1}), n, {1, 2, 3});
        std::vector<double> lobe(light.coefficients.size());
        clamped_cosine_lobe(order, glm::dvec3(n), lobe);
        glm::dvec3 exit(0);
        for (std::size_t i = 0; i < lobe.size(); ++i)
            exit += lobe[i] * glm::dvec3(light.coefficients[i]);
        EXPECT_LT(glm::distance(exit, glm::dvec3(1, 2, 3)), 1e-6);
    }
    EXPECT_THROW(scaled_to_exit_radiance(constant_light(3, {1, 0, 1}), {0, 1, 0}, {1, 1, 1}), Error);
}

TEST(Light, SumsAndBlends) {
    const Light a = constant_light(3, {1, 2, 3}), b = directional_light(3, {0, 1, 0}, {3, 2, 1});
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(sum(a, b).coefficients[i], a.coefficients[i] + b.coefficients[i]);
        EXPECT_LT(glm::distance(blended(a, b, 0.25f).coefficients[i],
                                0.75f * a.coefficients[i] + 0.25f * b.coefficients[i]),
                  1e-6f);
    }
    EXPECT_THROW(sum(a, constant_light(4, {1, 1, 1})), Error);
    EXPECT_THROW(blended(a, constant_light(4, {1, 1, 1}), 0.5f), Error);
}

TEST(Light, DeringedRadianceIsNowhereNegative) {
    const Light sun = directional_light(8, glm::normalize(glm::vec3(1, 3, 2)), {5, 4, 3});
    const Light dim = constant_light(8, {0.02f, 0.02f, 0.05f});
    const Light light = windowed(sum(sun, dim), Window::automatic);
    float least = 1e9f, largest = 0;
    for (const auto& [w, weight] : test::sphere_quadrature(200)) {
        const glm::vec3 value = radiance(light, glm::vec3(w));
        least = std::min({least, value.r, value.g, value.b});
        largest = std::max(largest, value.r);
    }
    EXPECT_GT(least, -1e-3f * largest);
    EXPECT_LT(glm::distance(light.coefficients[0], sum(sun, dim).coefficients[0]), 1e-5f); // energy stays
}

TEST(Sky, AgreesWithAFinerQuadrature) {
    const PreethamSky sky(3, glm::normalize(glm::dvec3(0.4, 0.6, 0.7)));
    const Light light = sky_light(6, sky);
    std::vector<glm::dvec3> expected(36, glm::dvec3(0));
    std::vector<double> y(36);
    for (const auto& [w, weight] : test::sphere_quadrature(600)) {
        evaluate_sh(6, w, std::span<double>(y));
        for (std::size_t i = 0; i < 36; ++i)
            expected[i] += y[i] * weight * sky.radiance(w);
    }
    for (std::size_t i = 0; i < 36; ++i)
        EXPECT_LT(glm::distance(glm::dvec3(light.coefficients[i]), expected[i]),
                  2e-3 * glm::length(expected[0])); // 600 points err so at the horizon, where the sky ends
    EXPECT_EQ(sky.radiance({0, -1, 0}), glm::dvec3(0));
    const glm::dvec3 zenith = sky.radiance({0, 1, 0});
    EXPECT_GT(zenith.b, zenith.r); // blue
    EXPECT_THROW(PreethamSky(3, {0, -1, 0}), Error);
    EXPECT_THROW(PreethamSky(3, {0, 2, 0}), Error);
    EXPECT_THROW(PreethamSky(40, {0, 1, 0}), Error);
}

} // namespace
} // namespace prt

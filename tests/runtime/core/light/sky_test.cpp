// The analytic sky by the tables of its paper (Preetham, Shirley and Smits 1999, appendix A.2), written down
// once more, and by the primaries of Rec. 709.

#include "prt/core/light.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

/// Five coefficients, each a factor of the turbidity and a constant.
using Distribution = double[5][2];

constexpr Distribution kPerezLuminance = {
    {0.1787, -1.4630}, {-0.3554, 0.4275}, {-0.0227, 5.3251}, {0.1206, -2.5771}, {-0.0670, 0.3703}};
constexpr Distribution kPerezX = {
    {-0.0193, -0.2592}, {-0.0665, 0.0008}, {-0.0004, 0.2125}, {-0.0641, -0.8989}, {-0.0033, 0.0452}};
constexpr Distribution kPerezY = {
    {-0.0167, -0.2608}, {-0.0950, 0.0092}, {-0.0079, 0.2102}, {-0.0441, -1.6537}, {-0.0109, 0.0529}};
/// Powers 2, 1, 0 of the turbidity by powers 3, 2, 1, 0 of the sun's angle to the zenith.
constexpr double kZenithX[3][4] = {{0.00166, -0.00375, 0.00209, 0},
                                   {-0.02903, 0.06377, -0.03202, 0.00394},
                                   {0.11693, -0.21196, 0.06052, 0.25886}};
constexpr double kZenithY[3][4] = {{0.00275, -0.00610, 0.00317, 0},
                                   {-0.04214, 0.08970, -0.04153, 0.00516},
                                   {0.15346, -0.26756, 0.06670, 0.26688}};

double perez(const Distribution& rows, double turbidity, double theta, double gamma) {
    double p[5];
    for (int i = 0; i < 5; ++i)
        p[i] = rows[i][0] * turbidity + rows[i][1];
    return (1 + p[0] * std::exp(p[1] / std::cos(theta))) *
           (1 + p[2] * std::exp(p[3] * gamma) + p[4] * std::pow(std::cos(gamma), 2));
}

double zenith(const double (&table)[3][4], double turbidity, double sun) {
    double sum = 0;
    for (int t = 0; t < 3; ++t)
        for (int s = 0; s < 4; ++s)
            sum += table[t][s] * std::pow(turbidity, 2 - t) * std::pow(sun, 3 - s);
    return sum;
}

glm::dvec3 xyz_of(double x, double y) {
    return {x / y, 1, (1 - x - y) / y};
}

/// From the chromaticities of Rec. 709 and its white, D65.
glm::dmat3 rgb_from_xyz() {
    const glm::dmat3 primaries(xyz_of(0.64, 0.33), xyz_of(0.30, 0.60), xyz_of(0.15, 0.06));
    const glm::dvec3 shares = glm::inverse(primaries) * xyz_of(0.3127, 0.3290);
    return glm::inverse(
        glm::dmat3(primaries[0] * shares.x, primaries[1] * shares.y, primaries[2] * shares.z));
}

TEST(PreethamSky, MatchesTheTablesOfThePaper) {
    const glm::dmat3 to_rgb = rgb_from_xyz();
    for (const double turbidity : {2.0, 3.5, 6.0})
        for (const double sun : {0.2, 0.7, 1.2}) {
            const PreethamSky sky(turbidity, {std::sin(sun), std::cos(sun), 0});
            const double chi = (4.0 / 9 - turbidity / 120) * (std::numbers::pi - 2 * sun);
            const double zenith_luminance =
                (4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
            for (const double theta : {0.0, 0.5, 1.0, 1.4})
                for (const double phi : {0.3, 2.0}) {
                    const glm::dvec3 w(std::sin(theta) * std::cos(phi), std::cos(theta),
                                       std::sin(theta) * std::sin(phi));
                    const double gamma = std::acos(std::sin(sun) * w.x + std::cos(sun) * w.y);
                    const auto relative = [&](const Distribution& rows) {
                        return perez(rows, turbidity, theta, gamma) / perez(rows, turbidity, 0, sun);
                    };
                    const double luminance = zenith_luminance * relative(kPerezLuminance);
                    const glm::dvec3 expected = to_rgb *
                                                xyz_of(zenith(kZenithX, turbidity, sun) * relative(kPerezX),
                                                       zenith(kZenithY, turbidity, sun) * relative(kPerezY)) *
                                                luminance;
                    const glm::dvec3 found = sky.radiance(w);
                    // The product's matrix has four digits.
                    EXPECT_LT(glm::distance(found, glm::max(expected, glm::dvec3(0))),
                              2e-3 * glm::length(expected))
                        << turbidity << " " << sun << " " << theta << " " << phi;
                }
        }
}

} // namespace
} // namespace prt

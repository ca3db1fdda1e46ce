// Tests zonal lobes: their words as defined in docs/format.md, their rotations, and their light.

#include "prt/core/lobes.h"

#include "prt/core/error.h"
#include "prt/core/light.h"
#include "prt/core/sh.h"
#include "prt/core/transfer.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace prt {
namespace lobes_of_vertices { // joined sources share one scope
namespace {

glm::vec3 any_direction(std::mt19937& random) {
    std::normal_distribution<float> normal;
    const float x = normal(random), y = normal(random), z = normal(random);
    return glm::normalize(glm::vec3(x, y, z));
}

void expect_near(const glm::vec3& found, const glm::vec3& wanted, float most = 1e-6f) {
    EXPECT_LT(glm::distance(found, wanted), most) << found.x << " " << found.y << " " << found.z;
}

LobeModel two_profiles() {
    LobeModel model;
    model.order = 4;
    model.lobes = 2;
    model.profiles = {{1, 2.0f / 3, 0.25f, 0}, {0.5f, -0.25f, 0.125f, 2}};
    return model;
}

TEST(Lobes, WordsFollowTheFormat) {
    const LobeModel model = two_profiles();
    // (190 - 127) / 127 and (64 - 127) / 127 result in z = 1/127.
    const Lobe lobe = model.decode(LobeWord{190, 64, 1, 51});
    expect_near(lobe.axis, glm::normalize(glm::vec3(63, -63, 1)));
    EXPECT_FLOAT_EQ(lobe.profile[0], 0.1f); // a fifth of the profile
    EXPECT_FLOAT_EQ(lobe.profile[3], 0.4f);
    // x = 100/127, y = -80/127: z = -53/127, and folded x = 47/127, y = -27/127.
    expect_near(model.decode(LobeWord{227, 47, 0, 255}).axis, glm::normalize(glm::vec3(47, -27, -53)));
    EXPECT_EQ(model.decode(LobeWord{255, 127, 0, 0}).axis, model.decode(LobeWord{254, 127, 0, 0}).axis);
}

TEST(Lobes, TheSixAxesAreExactAndOthersWithinADegree) {
    for (int a = 0; a < 3; ++a)
        for (const float sign : {-1.0f, 1.0f}) {
            glm::vec3 axis(0);
            axis[a] = sign;
            const auto code = coded_axis(axis);
            EXPECT_EQ(decoded_axis(code[0], code[1]), axis);
        }
    std::mt19937 random(1);
    float worst = 1;
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 axis = any_direction(random);
        const auto code = coded_axis(axis);
        worst = std::min(worst, glm::dot(axis, decoded_axis(code[0], code[1])));
    }
    EXPECT_GT(worst, std::cos(0.95f * 3.14159265f / 180));
}

TEST(Lobes, RotateLikeNormals) {
    std::mt19937 random(2);
    for (int i = 0; i < 50; ++i) {
        const glm::vec3 axis = any_direction(random);
        const glm::quat rotation = glm::angleAxis(0.1f * static_cast<float>(i), any_direction(random));
        expect_near(rotated_axis(axis, axis_rotation(3.0f * glm::mat3_cast(rotation))), rotation * axis);
        expect_near(rotated_axis(axis, axis_rotation(-glm::mat3_cast(rotation))),
                    -(rotation * axis)); // mirrored
        // The normal of a plane stays normal to it for any matrix.
        const glm::vec3 along = glm::normalize(glm::cross(axis, any_direction(random)));
        const glm::mat3 any(any_direction(random), 2.0f * any_direction(random), any_direction(random));
        EXPECT_NEAR(glm::dot(rotated_axis(axis, axis_rotation(any)), glm::normalize(any * along)), 0, 2e-4f);
    }
    expect_near(rotated_axis({0, 1, 0}, axis_rotation(glm::mat3(0))), {0, 1, 0});
}

TEST(Lobes, CosineLobeLightsAnOpenReceiver) {
    std::mt19937 random(4);
    Light light{4, {}};
    for (int i = 0; i < 16; ++i)
        light.coefficients.push_back(any_direction(random) + glm::vec3(i == 0 ? 9.0f : 0.0f));
    for (const int order : {2, 3, 4}) {
        const glm::vec3 normal = any_direction(random);
        Lobe lobe{normal, {}};
        for (int l = 0; l < 4; ++l)
            lobe.profile[static_cast<std::size_t>(l)] = static_cast<float>(clamped_cosine_factor(l));
        std::vector<double> cosine(static_cast<std::size_t>(order * order));
        clamped_cosine_lobe(order, glm::dvec3(normal), cosine);
        glm::vec3 expected(0);
        for (std::size_t i = 0; i < cosine.size(); ++i)
            expected += static_cast<float>(cosine[i]) * light.coefficients[i];
        expect_near(lobe_radiance({&lobe, 1}, light.coefficients, order), expected, 1e-5f);
    }
}

TEST(Lobes, SendOutNoNegativeLight) {
    const Lobe dark{{0, 0, 1}, {-1, 0, 0, 0}};
    EXPECT_EQ(lobe_radiance({&dark, 1}, constant_light(4, glm::vec3(1)).coefficients, 4), glm::vec3(0));
}

TEST(Lobes, InvalidLobesAreRejected) {
    const auto error_of = [](auto change) {
        LobeModel model = two_profiles();
        model.words = {{0, 0, 1, 0}, {0, 0, 0, 9}};
        change(model);
        try {
            check_lobes(model);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(error_of([](LobeModel&) {}), "");
    EXPECT_NE(error_of([](LobeModel& m) { m.order = 5; }).find("must be in 2..4, not 5"), std::string::npos);
    EXPECT_NE(error_of([](LobeModel& m) { m.lobes = 4; }).find("must be in 1..3, not 4"), std::string::npos);
    EXPECT_NE(error_of([](LobeModel& m) { m.profiles.clear(); }).find("must be in 1..256, not 0"),
              std::string::npos);
    EXPECT_NE(error_of([](LobeModel& m) { m.words[1][2] = 2; }).find("profile 2, but there are only 2"),
              std::string::npos);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), 1e4f})
        EXPECT_NE(error_of([&](LobeModel& m) { m.profiles[1][3] = bad; }).find("not finite or too large"),
                  std::string::npos);
}

} // namespace
} // namespace lobes_of_vertices
} // namespace prt

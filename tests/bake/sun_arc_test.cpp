// The sun over a day, and its light as keys of a light set.

#include "prt/sun_arc.h"

#include "prt/bake.h"
#include "prt/light_set.h"
#include "prt/support/error.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>

namespace prt {
namespace {

using test::SceneBuilder;

constexpr int kMarch = 81, kJune = 172, kDecember = 355;

double altitude(const glm::dvec3& towards) {
    return glm::degrees(std::asin(towards.y));
}

/// 90 degrees less latitude, more or less the tilt of the axis.
TEST(SunArc, StandsAsHighAtNoonAsItsLatitudeSays) {
    EXPECT_NEAR(altitude(towards_sun({.latitude = 0, .day = kMarch}, 12)), 90, 0.5);
    EXPECT_NEAR(altitude(towards_sun({.latitude = glm::radians(48.0), .day = kJune}, 12)), 65.44, 0.1);
    EXPECT_NEAR(altitude(towards_sun({.latitude = glm::radians(48.0), .day = kDecember}, 12)), 18.56, 0.1);
    EXPECT_NEAR(altitude(towards_sun({.latitude = glm::radians(-34.0), .day = kDecember}, 12)), 79.44, 0.1);
}

TEST(SunArc, RisesInTheEastAndPassesTheSouth) {
    const SunArc arc{.latitude = glm::radians(48.0), .day = kMarch};
    EXPECT_GT(towards_sun(arc, 6.1).x, 0.99);
    EXPECT_LT(towards_sun(arc, 17.9).x, -0.99);
    EXPECT_GT(towards_sun(arc, 12).z, 0.7);
    const glm::dvec3 turned = towards_sun({.latitude = arc.latitude, .day = kMarch, .north = {1, 0, 0}}, 6.1);
    EXPECT_GT(turned.z, 0.99); // to the right of +X is +Z
    EXPECT_GT(towards_sun({.latitude = glm::radians(-34.0), .day = kMarch}, 12).z, -0.7);
    EXPECT_LT(towards_sun({.latitude = glm::radians(-34.0), .day = kMarch}, 12).z, -0.5);
}

TEST(SunArc, HasKeysFromSunriseToSunset) {
    const auto keys = keys_of({.latitude = 0, .day = kMarch, .keys = 5, .half_angle = 0.1});
    ASSERT_EQ(keys.size(), 5u);
    EXPECT_EQ(keys.front().name, "sun 06:00");
    EXPECT_EQ(keys[2].name, "sun 12:00");
    EXPECT_EQ(keys.back().name, "sun 18:00");
    for (const PunctualLight& key : keys) {
        EXPECT_GT(-key.direction.y, -1e-6f);
        EXPECT_FLOAT_EQ(key.half_angle, 0.1f);
        EXPECT_TRUE(key.key);
    }
    EXPECT_EQ(keys_of({.latitude = 0, .keys = 1})[0].name, "sun 12:00");
}

TEST(SunArc, OfPolarDaysAndNights) {
    EXPECT_EQ(keys_of({.latitude = glm::radians(75.0), .day = kJune, .keys = 3})[0].name, "sun 00:00");
    EXPECT_THROW(keys_of({.latitude = glm::radians(75.0), .day = kDecember}), Error);
}

Scene floor_with(const std::vector<PunctualLight>& keys) {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 2, 4).build();
    scene.lights = keys;
    return scene;
}

BakeOptions options_of(LampMode mode) {
    BakeOptions options;
    options.order = 2;
    options.rays = 64;
    options.memory.storage = TransferStorage::float32;
    options.tracer.backend = Backend::cpu;
    options.lamps.mode = mode;
    return options;
}

/// R = E cos / pi, at any hour, with or without lamps of the scene.
TEST(SunArc, LightsAFloorAtEveryHour) {
    const SunArc arc{.latitude = glm::radians(30.0), .day = kMarch, .keys = 6, .half_angle = 0.02};
    Scene scene = floor_with(keys_of(arc));
    for (const LampMode mode : {LampMode::all, LampMode::none}) {
        const Transfer transfer = bake(scene, options_of(mode)).baked.transfer;
        for (const double hour : {7.0, 9.3, 12.0, 16.8}) {
            Lighting lighting{constant_light(2, glm::vec3(0))};
            lighting.lamps = strengths_of_scene(transfer.layout);
            const glm::dvec3 sun = towards_sun(arc, hour);
            add_sun(transfer.layout, {glm::vec3(sun), glm::vec3(3)}, lighting.lamps);
            for (const glm::vec3& r : exit_radiance(transfer, lighting))
                EXPECT_NEAR(r.g, 3 * sun.y / std::numbers::pi, 0.02) << hour;
        }
        EXPECT_EQ(exit_radiance(transfer, constant_light(2, glm::vec3(0)))[0],
                  glm::vec3(0)); // until it is set
    }
}

/// A wall to the edge of whose shadow the middle of the disc comes hides half of it.
TEST(SunArc, HasTheSunsPenumbra) {
    PunctualLight key;
    key.name = "sun";
    key.kind = PunctualKind::directional;
    key.key = true;
    key.direction = glm::normalize(glm::vec3(1, -1, 0));
    key.half_angle = 0.2f;
    Scene scene = SceneBuilder()
                      .floor({0, 0, 0}, 2, 16)
                      .quad({-0.5f, 0, 4}, {-0.5f, 0, -4}, {-0.5f, 1, -4}, {-0.5f, 1, 4})
                      .build();
    scene.lights = {key};
    BakeOptions options = options_of(LampMode::none);
    options.lamps.rays = 1024;
    const Transfer transfer = bake(scene, options).baked.transfer;
    Lighting lighting{constant_light(2, glm::vec3(0))};
    lighting.lamps = {glm::vec3(1)};
    const auto lit = exit_radiance(transfer, lighting);
    const VertexArray& floor = scene.vertex_arrays[0];
    const double open = std::sqrt(0.5) / std::numbers::pi;
    int dark = 0, half = 0, full = 0;
    for (std::size_t p = 0; p < floor.size(); ++p) {
        const float x = floor.positions[p].x;
        if (x < -0.4f) // in the wall, or before it
            continue;
        // From there the top of the wall stands at 45 degrees where x is 0.5.
        const double top = std::atan2(1.0, static_cast<double>(x) + 0.5), middle = std::numbers::pi / 4;
        const double share = static_cast<double>(lit[p].g) / open;
        if (top > middle + 0.21) {
            EXPECT_EQ(share, 0) << x;
            ++dark;
        } else if (top < middle - 0.21) {
            EXPECT_NEAR(share, 1, 0.01) << x;
            ++full;
        } else if (std::abs(x - 0.5f) < 1e-4f) {
            EXPECT_NEAR(share, 0.5, 0.05) << x; // the lower half has the smaller cosine
            ++half;
        }
    }
    EXPECT_GT(dark, 0);
    EXPECT_GT(half, 0);
    EXPECT_GT(full, 0);
}

/// A day of minutes has keys that differ by seconds.
TEST(SunArc, OfShortDaysHasNamesThatDiffer) {
    const auto keys = keys_of({.latitude = glm::radians(66.54), .day = kDecember, .keys = 24});
    std::set<std::string> names;
    for (const PunctualLight& key : keys)
        names.insert(key.name);
    EXPECT_EQ(names.size(), 24u);
}

/// Bounces alone of lamps, and all of keys, which no renderer adds to.
TEST(SunArc, KeepsItsDirectLightWhereLampsDoNot) {
    Scene scene = floor_with({});
    PunctualLight key;
    key.name = "noon";
    key.kind = PunctualKind::directional;
    key.key = true;
    key.direction = {0, -1, 0};
    scene.lights = {{.name = "lamp", .position = {0, 1, 0}}, key};
    BakeOptions options = options_of(LampMode::indirect);
    options.bounces = 1;
    const Transfer transfer = bake(scene, options).baked.transfer;
    Lighting lighting{constant_light(2, glm::vec3(0))};
    lighting.lamps = {glm::vec3(1), glm::vec3(0)};
    EXPECT_NEAR(exit_radiance(transfer, lighting)[12].g, 0, 1e-6);
    lighting.lamps = {glm::vec3(0), glm::vec3(1)};
    EXPECT_NEAR(exit_radiance(transfer, lighting)[12].g, 1 / std::numbers::pi, 1e-5);
}

TEST(SunArc, OfTwoKeysOfOneNameIsRefused) {
    auto keys = keys_of({.latitude = 0, .keys = 2});
    keys[1].name = keys[0].name;
    EXPECT_THROW(bake(floor_with(keys), options_of(LampMode::all)), Error);
}

} // namespace
} // namespace prt

// Light of lamps against closed forms: inverse squares, cones, discs, spheres, closed rooms.

#include "prt/bake/bake.h"

#include "bake/trace/choose_lamps.h"
#include "prt/core/error.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace prt {
namespace {

using test::SceneBuilder;

PunctualLight point(const std::string& name, const glm::vec3& position,
                    const glm::vec3& intensity = glm::vec3(1)) {
    PunctualLight light;
    light.name = name;
    light.intensity = intensity;
    light.position = position;
    return light;
}

/// A floor about the origin, facing up, with these lights.
Scene floor_under(const std::vector<PunctualLight>& lights) {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 2, 8).build();
    scene.lights = lights;
    return scene;
}

BakeOptions lamp_options(int bounces = 0) {
    BakeOptions options;
    options.order = 2;
    options.rays = 64;
    options.bounces = bounces;
    options.memory.storage = TransferStorage::float32;
    options.tracer.backend = Backend::cpu;
    return options;
}

/// Radiance of every receiver by lamps alone, all at strength 1.
std::vector<glm::vec3> lit_by_lamps(const Scene& scene, const BakeOptions& options) {
    const Transfer transfer = bake(scene, options).baked.transfer;
    return exit_radiance(transfer, constant_light(options.order, glm::vec3(0)));
}

/// Calls `check` with the position of every receiver and the result of `expected` there.
void expect_radiance(const Scene& scene, const BakeOptions& options,
                     const std::function<glm::dvec3(const glm::dvec3&)>& expected, double tolerance) {
    const auto lit = lit_by_lamps(scene, options);
    const VertexArray& floor = scene.vertex_arrays[0];
    double largest = 0;
    for (std::size_t p = 0; p < floor.size(); ++p) {
        const glm::dvec3 right = expected(glm::dvec3(floor.positions[p]));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(lit[p][c], right[c], tolerance) << "receiver " << p << ", channel " << c;
            largest = std::max(largest, right[c]);
        }
    }
    EXPECT_GT(largest, 10 * tolerance); // otherwise the test checks nothing
}

/// R = I cos / (pi d²).
TEST(Lamps, PointsFollowTheInverseSquareLaw) {
    const glm::dvec3 at(0.3, 1.5, -0.2), intensity(2, 1, 0.5);
    expect_radiance(
        floor_under({point("lamp", glm::vec3(at), glm::vec3(intensity))}), lamp_options(),
        [&](const glm::dvec3& p) {
            const glm::dvec3 to = at - p;
            return intensity * to.y / (std::numbers::pi * std::pow(glm::length(to), 3));
        },
        1e-5);
}

/// A sphere lights points outside it like a point light at its center.
TEST(Lamps, SpheresAreAsBrightAsPoints) {
    BakeOptions options = lamp_options();
    options.lamps.radius = 0.4;
    const glm::dvec3 at(0.3, 1.5, -0.2);
    expect_radiance(
        floor_under({point("lamp", glm::vec3(at))}), options,
        [&](const glm::dvec3& p) {
            const glm::dvec3 to = at - p;
            return glm::dvec3(to.y / (std::numbers::pi * std::pow(glm::length(to), 3)));
        },
        2e-4); // 64 points of a spiral
}

TEST(Lamps, EndAtTheirRange) {
    PunctualLight light = point("lamp", {0, 1, 0});
    light.range = 1.5f;
    expect_radiance(
        floor_under({light}), lamp_options(),
        [](const glm::dvec3& p) {
            const double square = 1 + glm::dot(p, p);
            const double left = std::max(0.0, 1 - square * square / std::pow(1.5, 4));
            return glm::dvec3(left / (std::numbers::pi * std::pow(square, 1.5)));
        },
        1e-5);
}

/// The intensity is full within the inner cone and zero outside the outer one; in between it is the square of
/// a function linear in the cosine.
TEST(Lamps, SpotsFadeAtTheirCone) {
    PunctualLight light = point("lamp", {0, 2, 0});
    light.kind = PunctualKind::spot;
    light.direction = {0, -1, 0};
    light.inner_cone = 0.3f;
    light.outer_cone = 0.6f;
    int full = 0, none = 0, between = 0;
    expect_radiance(
        floor_under({light}), lamp_options(),
        [&](const glm::dvec3& p) {
            const double distance = std::sqrt(4 + glm::dot(p, p)), cosine = 2 / distance;
            const double rise =
                std::clamp((cosine - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6)), 0.0, 1.0);
            (rise == 1 ? full : rise == 0 ? none : between) += 1;
            return glm::dvec3(rise * rise * cosine / (std::numbers::pi * distance * distance));
        },
        1e-5);
    EXPECT_GT(full, 0);
    EXPECT_GT(none, 0);
    EXPECT_GT(between, 0);
}

TEST(Lamps, FarAwayLightUniformly) {
    PunctualLight light = point("lamp", {0, 0, 0}, glm::vec3(3));
    light.kind = PunctualKind::directional;
    light.direction = glm::normalize(glm::vec3(0.5f, -1, 0));
    expect_radiance(
        floor_under({light}), lamp_options(),
        [](const glm::dvec3&) { return glm::dvec3(3 / (std::numbers::pi * std::sqrt(1.25))); }, 1e-5);
}

/// The shadow of a roof under a point light is sharp, and starts where the line to the light passes through
/// the roof.
TEST(Lamps, CastShadows) {
    Scene scene = test::join(
        {SceneBuilder().floor({0, 0, 0}, 2, 8).build(), SceneBuilder().floor({0, 1, 0}, 0.61f, 1).build()});
    scene.lights = {point("lamp", {0, 2, 0})};
    expect_radiance(
        scene, lamp_options(),
        [](const glm::dvec3& p) {
            const bool shadowed = std::max(std::abs(p.x), std::abs(p.z)) < 2 * 0.61;
            return glm::dvec3(shadowed ? 0 : 2 / (std::numbers::pi * std::pow(4 + glm::dot(p, p), 1.5)));
        },
        1e-5);
}

/// A floor, and a shape in front of it that shines.
Scene floor_with(Scene shining, const glm::vec3& radiance, bool double_sided = false) {
    shining.materials[0].emission.radiance = radiance;
    shining.materials[0].double_sided = double_sided;
    shining.materials[0].name = "sign";
    return test::join({SceneBuilder().floor({0, 0, 0}, 2, 8).build(), shining});
}

/// E = pi L sin² of its half angle times the cosine, while all of it is above the horizon.
TEST(Lamps, SpheresFollowTheirSolidAngle) {
    BakeOptions options = lamp_options();
    options.lamps.rays = 256;
    expect_radiance(
        floor_with(SceneBuilder().sphere({0, 1.2f, 0}, 0.5f, 48).build(), {4, 2, 1}), options,
        [](const glm::dvec3& p) {
            const glm::dvec3 to = glm::dvec3(0, 1.2, 0) - p;
            const double square = glm::dot(to, to);
            return glm::dvec3(4, 2, 1) * 0.25 / square * to.y / std::sqrt(square);
        },
        // The polyhedron lies within the sphere by (pi / 48)² / 6 of its radius, a share of its image of 0.2
        // % and some more where its triangles are seen from the side; the rest is sampling.
        0.02);
}

/// A square over a floor: Lambert's form factor of a polygon, exact for any distance (Lambert 1760).
double of_polygon(const std::vector<glm::dvec3>& corners, const glm::dvec3& p) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a = glm::normalize(corners[i] - p),
                         b = glm::normalize(corners[(i + 1) % corners.size()] - p);
        const glm::dvec3 across = glm::cross(a, b);
        sum += std::atan2(glm::length(across), glm::dot(a, b)) * across.y / glm::length(across);
    }
    return std::abs(sum) / (2 * std::numbers::pi);
}

TEST(Lamps, PolygonsFollowLambertsFormula) {
    for (const double height : {1.5, 0.3, 0.02}) { // nearer than its triangles are large, too
        BakeOptions options = lamp_options();
        options.lamps.rays = 1024;
        const double s = 0.7;
        const std::vector<glm::dvec3> corners = {
            {-s, height, -s}, {s, height, -s}, {s, height, s}, {-s, height, s}};
        expect_radiance(
            floor_with(
                SceneBuilder().floor({0, static_cast<float>(height), 0}, static_cast<float>(s), 2).build(),
                glm::vec3(2), true),
            // Below the square R = 2 (2 cos), of standard deviation 1.15: 0.036 over 1024 rays that were not
            // spread evenly.
            options, [&](const glm::dvec3& p) { return glm::dvec3(2 * of_polygon(corners, p)); }, 0.02);
    }
}

/// A floor meets a wall that shines: at the edge half of the sky of a vertex is wall, of which all are seen
/// edge on from the wall's own plane.
TEST(Lamps, LightReceiversInTheirPlane) {
    Scene wall = SceneBuilder()
                     .quad({-50, 0, 0}, {50, 0, 0}, {50, 100, 0}, {-50, 100, 0}) // faces +z
                     .build();
    wall.materials[0].emission.radiance = glm::vec3(1);
    const Scene scene = test::join({SceneBuilder()
                                        .quad({-1, 0, 0}, {-1, 0, 2}, {1, 0, 2}, {1, 0, 0}) // faces up
                                        .build(),
                                    wall});
    BakeOptions options = lamp_options();
    options.lamps.rays = 1024;
    const auto lit = lit_by_lamps(scene, options);
    const VertexArray& floor = scene.vertex_arrays[0];
    for (std::size_t p = 0; p < floor.size(); ++p)
        if (floor.positions[p].z == 0) {
            EXPECT_NEAR(lit[p].x, 0.5f, 0.02f) << p;
        }
}

/// An emitter with opacity one quarter emits a quarter, and one that is cut out emits nothing.
TEST(Lamps, EmitByTheirOpacity) {
    Scene scene = floor_with(SceneBuilder().floor({0, 1, 0}, 0.7f, 2).build(), glm::vec3(2), true);
    const auto whole = lit_by_lamps(scene, lamp_options());
    Material& sign = scene.materials[scene.primitives[1].material];
    sign.alpha_mode = AlphaMode::blend;
    sign.base_color.a = 0.25f;
    const auto quarter = lit_by_lamps(scene, lamp_options());
    sign.alpha_mode = AlphaMode::mask;
    const auto none = lit_by_lamps(scene, lamp_options());
    ASSERT_GT(whole[40].x, 0.03f);
    EXPECT_NEAR(quarter[40].x, 0.25f * whole[40].x, 1e-3f);
    EXPECT_EQ(none[40].x, 0);
}

TEST(Lamps, EmitOnlyFromTheFront) {
    const Scene ceiling = floor_with(SceneBuilder().floor({0, 1, 0}, 0.7f, 2).build(), glm::vec3(2));
    const auto lit = lit_by_lamps(ceiling, lamp_options());
    for (const glm::vec3& r : lit)
        EXPECT_EQ(r, glm::vec3(0));
}

/// A ball of radius 1 with its front inside.
Scene closed_room(int rows, const glm::vec3& color) {
    Scene room = test::painted(SceneBuilder().sphere({0, 0, 0}, 1, rows).build(), color);
    for (glm::uvec3& t : room.primitives[0].triangles)
        std::swap(t.y, t.z);
    for (glm::vec3& normal : room.vertex_arrays[0].normals)
        normal = -normal;
    return room;
}

/// In a closed ball of albedo rho with an emissive wall, irradiance over pi is L (1 + rho + rho² ...).
TEST(Lamps, FillAClosedRoomByAllBounces) {
    Scene ball = closed_room(24, glm::vec3(0.5f));
    ball.materials[0].emission.radiance = glm::vec3(3);
    BakeOptions options = lamp_options(kEndlessBounces);
    options.rays = options.lamps.rays = 1024;
    const Transfer transfer = bake(ball, options).baked.transfer;
    ASSERT_EQ(transfer.layout.terms.size(), 1u); // no sky light enters
    EXPECT_EQ(transfer.layout.terms[0].kind, TermKind::lamp);
    EXPECT_EQ(transfer.layout.terms[0].channels, 1);
    const auto lit = exit_radiance(transfer, constant_light(2, glm::vec3(1)));
    const std::vector<float> areas = receiver_areas(ball);
    // Faces tilt by up to 5.3 degrees from the plane of a vertex, and no light comes from the gap: the
    // fraction sin² of the light, 0.85 %, is missing before each bounce, so at least 5.9 remain. Samples of 6
    // cos have a standard deviation of 1.73: 0.054 over 1024 samples that are not stratified.
    for (std::size_t p = 0; p < lit.size(); ++p)
        if (areas[p] > 0) {
            EXPECT_LT(lit[p].x, 6.06f) << p;
            EXPECT_GT(lit[p].x, 5.84f) << p;
        }
}

/// Each lamp is a part, by its name, and a group is the sum of its members.
TEST(Lamps, GroupsAreSums) {
    Scene scene = test::join({SceneBuilder().floor({0, 0, 0}, 2, 8).build(),
                              SceneBuilder().sphere({0.5f, 0.7f, 0}, 0.3f, 8).build()});
    scene = test::painted(std::move(scene), {0.8f, 0.5f, 0.2f});
    scene.lights = {point("Lamp.left", {-1, 1, 0}, {1, 0.5f, 0}), point("Torch", {0, 1, 1}),
                    point("Lamp.right", {1, 1.5f, 0})};
    BakeOptions options = lamp_options(0); // how bounces are sampled depends on the lamps
    const Transfer separate = bake(scene, options).baked.transfer;
    ASSERT_EQ(separate.layout.lamps(), 3u);
    options.lamps.groups = {{"lamps", "Lamp.*"}};
    const Transfer grouped = bake(scene, options).baked.transfer;
    ASSERT_EQ(grouped.layout.lamps(), 2u);
    EXPECT_EQ((grouped.layout.terms.end() - 2)->name, "lamps");
    EXPECT_EQ((grouped.layout.terms.end() - 1)->name, "Torch");
    Lighting both{constant_light(2, glm::vec3(0))}, group = both;
    both.lamps = {glm::vec3(2, 1, 0.5f), glm::vec3(0), glm::vec3(2, 1, 0.5f)};
    group.lamps = {glm::vec3(2, 1, 0.5f), glm::vec3(0)};
    const auto a = exit_radiance(separate, both), b = exit_radiance(grouped, group);
    for (std::size_t p = 0; p < a.size(); ++p)
        EXPECT_LT(glm::distance(a[p], b[p]), 1e-5f * (1 + glm::length(a[p])));
}

TEST(Lamps, IndirectModeOmitsDirectLight) {
    Scene scene = test::painted(test::join({SceneBuilder().floor({0, 0, 0}, 2, 8).build(),
                                            SceneBuilder().sphere({0.5f, 0.7f, 0}, 0.3f, 8).build()}),
                                glm::vec3(0.5f));
    scene.lights = {point("lamp", {-1, 1, 0}, {1, 0.5f, 0})};
    BakeOptions options = lamp_options(2);
    const auto all = lit_by_lamps(scene, options);
    options.lamps.mode = LampMode::indirect;
    const auto indirect = lit_by_lamps(scene, options);
    const auto direct = lit_by_lamps(scene, lamp_options(0));
    float most = 0;
    for (std::size_t p = 0; p < all.size(); ++p) {
        EXPECT_LT(glm::distance(all[p], direct[p] + indirect[p]), 1e-6f);
        most = std::max(most, indirect[p].x);
    }
    EXPECT_GT(most, 1e-3f);
    options.lamps.mode = LampMode::none;
    EXPECT_EQ(bake(scene, options).baked.transfer.layout.lamps(), 0u);
}

TEST(Lamps, AreFiniteAtExtremePositions) {
    Scene scene = test::join(
        {SceneBuilder().floor({0, 0, 0}, 2, 8).build(), SceneBuilder().sphere({0, 1, 0}, 0.3f, 16).build()});
    scene.lights = {point("on a vertex", {0, 0, 0}), point("in a wall", {0, 1, 0})};
    for (const double radius : {0.0, 0.1}) {
        BakeOptions options = lamp_options();
        options.lamps.radius = radius;
        const Transfer transfer = bake(scene, options).baked.transfer;
        for (const float v : transfer.vectors)
            EXPECT_TRUE(std::isfinite(v));
        Lighting in_wall{constant_light(2, glm::vec3(0))};
        in_wall.lamps = {glm::vec3(0), glm::vec3(1)};
        for (const glm::vec3& r : exit_radiance(transfer, in_wall))
            EXPECT_EQ(r, glm::vec3(0));
    }
}

std::string error_of(const Scene& scene, const BakeOptions& options) {
    try {
        bake(scene, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Lamps, InvalidLampsAreRejected) {
    const Scene scene = floor_under({point("lamp", {0, 1, 0})});
    BakeOptions options = lamp_options();
    options.lamps.groups = {{"group", "Lantern*"}};
    EXPECT_NE(error_of(scene, options).find("'Lantern*'"), std::string::npos);
    options = lamp_options();
    options.lamps.radius = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(error_of(scene, options).find("radius"), std::string::npos);
    options = lamp_options();
    options.lamps.rays = 0;
    EXPECT_NE(error_of(scene, options).find("rays"), std::string::npos);
    std::vector<PunctualLight> many;
    for (int i = 0; i < 10000; ++i)
        many.push_back(point("lamp" + std::to_string(i), {0, 1, 0}));
    EXPECT_NE(error_of(floor_under(many), lamp_options()).find("10000 lamps"), std::string::npos);
    EXPECT_NE(error_of(floor_under({point("lamp", {0, 1, 0}, glm::vec3(1e9f))}), lamp_options()).find("1e6"),
              std::string::npos);
}

/// Light without absorption would grow without bound.
TEST(Lamps, InWhiteClosedRoomsNeedAFiniteNumberOfBounces) {
    Scene room = closed_room(12, glm::vec3(1));
    room.primitives[0].node_name = "White room";
    for (const float intensity : {1e-4f, 1.0f}) {
        room.lights = {point("lamp", {0, 0, 0}, glm::vec3(intensity))};
        const std::string error = error_of(room, lamp_options(kEndlessBounces));
        EXPECT_NE(error.find("does not converge"), std::string::npos);
        EXPECT_NE(error.find("White room"), std::string::npos);
        EXPECT_EQ(error_of(room, lamp_options(3)), "no error");
    }
}

TEST(Lamps, NamesOfOtherGroupsAreRejected) {
    const Scene scene = floor_under({point("Lantern", {0, 1, 0}), point("Bulb", {1, 1, 0})});
    BakeOptions options = lamp_options();
    options.lamps.groups = {{"Lantern", "Bulb"}};
    EXPECT_NE(error_of(scene, options).find("'Lantern'"), std::string::npos);
    options.lamps.groups = {{"Lantern", "*"}};
    EXPECT_EQ(error_of(scene, options), "no error");
}

TEST(Lamps, AreFoundByPatterns) {
    EXPECT_TRUE(matches("Lamp.001", "Lamp*"));
    EXPECT_TRUE(matches("Lamp.001", "*1"));
    EXPECT_TRUE(matches("Lamp.001", "L?mp*0*"));
    EXPECT_TRUE(matches("", "*"));
    EXPECT_TRUE(matches("abcabd", "*ab?"));
    EXPECT_FALSE(matches("Lamp", "lamp"));
    EXPECT_FALSE(matches("Lamp", "Lamp?"));
    EXPECT_FALSE(matches("Lamp", "La"));
    EXPECT_FALSE(matches("Lamp", ""));
}

} // namespace
} // namespace prt

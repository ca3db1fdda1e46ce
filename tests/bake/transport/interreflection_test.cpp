// Tests bounces against closed forms and brute force.

#include "bake/plan/available_memory.h"
#include "prt/bake/bake.h"
#include "prt/core/error.h"
#include "prt/core/light.h"
#include "prt/gltf/gltf.h"
#include "support/bounce_off_triangle.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

namespace prt {
namespace {

using std::numbers::pi;
using test::SceneBuilder;

BakeResult bake_bounces(const Scene& scene, int bounces, int rays = 1024, int order = 3) {
    BakeOptions options;
    options.order = order;
    options.rays = rays;
    options.bounces = bounces;
    options.tracer.backend = Backend::cpu;
    return bake(scene, options);
}

/// Exit radiance for albedo 1 under uniform light of radiance 1.
std::vector<glm::vec3> under_uniform_light(const Transfer& transfer) {
    return exit_radiance(transfer, constant_light(transfer.layout.order, glm::vec3(1)));
}

struct Bowl {
    Scene scene;
    double share; ///< fraction of the sphere that is wall
};

Bowl make_bowl(double albedo) {
    constexpr int kRows = 40, kOpen = 10; // open to polar angle 45 degrees
    return {test::painted(SceneBuilder().bowl({1, 2, 3}, 0.5f, kRows, kOpen).build(),
                          glm::vec3(static_cast<float>(albedo))),
            1 - (1 - std::cos(pi * kOpen / kRows)) / 2};
}

// Inside a sphere of radius r the gather from a surface is its mean over the sphere: rho/(4 pi r²) ∫ f dA.
// The opening shows radiance 1, so R_0 = 1 - a, and every bounce multiplies by rho a.
TEST(SphericalBowl, BouncesAreAGeometricSeries) {
    constexpr double kAlbedo = 0.8;
    const Bowl bowl = make_bowl(kAlbedo);
    const std::vector<float> areas = receiver_areas(bowl.scene);
    for (const int bounces : {0, 1, 2, 5, kEndlessBounces}) {
        const BakeResult result = bake_bounces(bowl.scene, bounces);
        EXPECT_EQ(result.baked.transfer.layout.channels(), 1);
        double expected = 0, term = 1 - bowl.share;
        for (int k = 0; k <= (bounces < 0 ? 200 : bounces); ++k, term *= kAlbedo * bowl.share)
            expected += term;
        const auto radiance = under_uniform_light(result.baked.transfer);
        double sum = 0, area = 0;
        for (std::size_t p = 0; p < radiance.size(); ++p) {
            sum += static_cast<double>(areas[p] * radiance[p].x);
            area += static_cast<double>(areas[p]);
            // Chords cut the sphere: a facet of 4.5 degrees lies 0.1 % inside, and rays are noisy.
            if (areas[p] > 0) {
                EXPECT_NEAR(static_cast<double>(radiance[p].x), expected, 0.08 * expected) << bounces;
            }
        }
        EXPECT_NEAR(sum / area, expected, 0.006 * expected) << bounces;
    }
}

TEST(SphericalBowl, EndlessBouncesConverge) {
    const BakeResult result = bake_bounces(make_bowl(0.8).scene, kEndlessBounces, 256);
    EXPECT_LT(result.statistics.remaining_energy, 1e-5);
    // Iterating bounces takes 31 steps until 0.8 · 0.854 to the power n is below 1e-5.
    EXPECT_LT(result.baked.record.bounces, 25);
}

/// Adds one side of a box about `middle`, seen along `axis` (0..5: +x, -x, ...), of cells x cells quads whose
/// fronts face inwards, with a square hole of half side `hole` in its middle.
void add_side(SceneBuilder& builder, const glm::vec3& middle, int axis, int cells, float hole) {
    glm::vec3 out(0), u(0), v(0);
    out[axis / 2] = axis % 2 == 0 ? 1.0f : -1.0f;
    u[(axis / 2 + 1) % 3] = 1;
    v = glm::cross(u, out);
    const auto at = [&](float x, float y) { return middle + out + x * u + y * v; };
    if (hole > 0) { // four quads round it
        builder.quad(at(-1, -1), at(hole, -1), at(hole, -hole), at(-1, -hole));
        builder.quad(at(hole, -1), at(1, -1), at(1, hole), at(hole, hole));
        builder.quad(at(-hole, hole), at(1, hole), at(1, 1), at(-hole, 1));
        builder.quad(at(-1, -hole), at(-hole, -hole), at(-hole, 1), at(-1, 1));
        return;
    }
    const auto step = [&](int k) { return 2 * static_cast<float>(k) / static_cast<float>(cells) - 1; };
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            builder.quad(at(step(i), step(j)), at(step(i + 1), step(j)), at(step(i + 1), step(j + 1)),
                         at(step(i), step(j + 1)));
}

/// White closed rooms side by side along x; each opens to the next, and the last to the sky, by a hole.
Scene rooms_with_pin_holes(int rooms, float hole, int cells) {
    SceneBuilder builder;
    for (int room = 0; room < rooms; ++room)
        for (int axis = 0; axis < 6; ++axis)
            if (axis != 1 || room == 0) // neighbours share a wall
                add_side(builder, {2.0f * static_cast<float>(room), 0, 0}, axis, cells, axis == 0 ? hole : 0);
    return test::painted(builder.build(), glm::vec3(1), true);
}

class PinHole : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Rooms, PinHole, testing::Values(1, 2));

TEST_P(PinHole, LightsAWhiteRoomLikeTheSky) {
    // Light gets out after thousands of bounces: some 0.01 / 24 of the walls is hole.
    const Scene scene = rooms_with_pin_holes(GetParam(), 0.05f, 6);
    const BakeResult result = bake_bounces(scene, kEndlessBounces, 1024, 2);
    EXPECT_LT(result.baked.record.bounces, 60);
    const auto radiance = under_uniform_light(result.baked.transfer);
    const std::vector<float> areas = receiver_areas(scene);
    for (std::size_t p = 0; p < radiance.size(); ++p)
        EXPECT_NEAR(radiance[p].x, 1, 1e-4f) << p;
}

TEST(SphericalBowl, EveryBandIsGatheredEqually) {
    // From the first bounce on the transfer is equal everywhere: the mean of the direct one.
    const Bowl bowl = make_bowl(1);
    const Transfer direct = bake_bounces(bowl.scene, 0, 4096).baked.transfer;
    const Transfer once = as_combined(bake_bounces(bowl.scene, 1, 4096).baked.transfer);
    const std::vector<float> areas = receiver_areas(bowl.scene);
    std::array<double, 9> mean{};
    double area = 0;
    for (std::size_t p = 0; p < areas.size(); ++p) {
        area += static_cast<double>(areas[p]);
        for (std::size_t k = 0; k < 9; ++k)
            mean[k] += static_cast<double>(areas[p] * direct.vector(p)[k]);
    }
    for (std::size_t p = 0; p < areas.size(); p += 37) {
        if (areas[p] == 0)
            continue;
        for (std::size_t k = 0; k < 9; ++k)
            EXPECT_NEAR(static_cast<double>(once.vector(p)[k] - direct.vector(p)[k]),
                        bowl.share * mean[k] / area, 0.006)
                << p << " " << k;
    }
}

/// Returns the cosine-weighted fraction of the hemisphere above a point that a parallel disc covers: the disc
/// has `radius`, height `height` above the point, and its axis at distance `offset` (the view factor of an
/// element to a parallel disc).
double disc_factor(double height, double radius, double offset) {
    if (offset < 1e-9)
        return radius * radius / (radius * radius + height * height);
    const double h = height / offset, r = radius / offset, z = 1 + h * h + r * r;
    return 0.5 * (1 - (z - 2 * r * r) / std::sqrt(z * z - 4 * r * r));
}

TEST(ParallelPlates, OneBounceIsTheIntegralOverTheOtherPlate) {
    // Two discs face each other. The lower one sees the sky past the upper one, and that the other way round.
    constexpr double kHeight = 0.5, kRadius = 1, kAlbedo = 0.6;
    const auto plate = [](float y, float up) {
        SceneBuilder builder;
        for (int ring = 0; ring < 12; ++ring) { // fine rings, so that values between vertices are linear
            const auto at = [&](int r, int i) {
                const double angle = 2 * pi * i / 48, radius = kRadius * r / 12;
                return glm::vec3(radius * std::sin(angle), y, radius * std::cos(angle));
            };
            for (int i = 0; i < 48; ++i) {
                const int j = up > 0 ? i + 1 : i - 1;
                builder.quad(at(ring, i), at(ring + 1, i), at(ring + 1, j), at(ring, j));
            }
        }
        return builder.build();
    };
    const Scene scene = test::painted(test::join({plate(0, 1), plate(static_cast<float>(kHeight), -1)}),
                                      glm::vec3(static_cast<float>(kAlbedo)));
    const auto radiance = under_uniform_light(bake_bounces(scene, 1, 4096).baked.transfer);
    // The middle of the lower plate: kernel cos cos / (pi d²) = h² / (pi (h² + r²)²).
    double bounce = 0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
        const double r = kRadius * (i + 0.5) / kSteps;
        const double kernel = kHeight * kHeight / (pi * std::pow(kHeight * kHeight + r * r, 2));
        bounce += kAlbedo * (1 - disc_factor(kHeight, kRadius, r)) * kernel * 2 * pi * r * kRadius / kSteps;
    }
    const double expected = 1 - disc_factor(kHeight, kRadius, 0) + bounce;
    EXPECT_NEAR(static_cast<double>(radiance[0].x), expected, 0.01 * expected);
    EXPECT_GT(bounce, 0.2 * expected); // the bounce matters here
}

TEST(WhiteFurnace, IsExactlyOneForAllGeometries) {
    // A bowl with things in it: a sphere, a sheet that is seen from both sides, needles, a pile of triangles.
    SceneBuilder things;
    things.sphere({0, -0.2f, 0}, 0.3f, 12).floor({0, 0.25f, 0.1f}, 0.3f, 6);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-0.5f, 0.5f);
    const auto point = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    for (int i = 0; i < 30; ++i) {
        const glm::vec3 a = point();
        things.triangle(a, a + 0.3f * point(), a + 0.3f * point());
    }
    const Scene scene = test::painted(
        test::join({SceneBuilder().bowl({0, 0, 0}, 1, 24, 8).build(), things.build()}), glm::vec3(1), true);
    const BakeResult result = bake_bounces(scene, kEndlessBounces, 512, 2);
    const auto radiance = under_uniform_light(result.baked.transfer);
    const std::vector<float> areas = receiver_areas(scene);
    int looked_at = 0;
    for (std::size_t p = 0; p < radiance.size(); ++p)
        if (areas[p] > 0 && radiance[p].x > 0) {
            EXPECT_NEAR(radiance[p].x, 1, 1e-4f) << p;
            ++looked_at;
        }
    EXPECT_GT(looked_at, 1000);
}

// Brute force by an independent method: random walks against every triangle, in double precision.
class BouncedPaths {
public:
    explicit BouncedPaths(const Scene& scene) {
        for (const Primitive& primitive : scene.primitives)
            for (const glm::uvec3& t : primitive.triangles) {
                const auto& p = scene.vertex_arrays[primitive.vertices].positions;
                triangles_.push_back({glm::dvec3(p[t.x]), glm::dvec3(p[t.y]), glm::dvec3(p[t.z]),
                                      glm::dvec3(scene.materials[primitive.material].base_color)});
            }
    }

    /// Returns the exit radiance of a receiver of albedo 1 under uniform light, with at most `bounces`
    /// bounces.
    glm::dvec3 radiance(glm::dvec3 position, glm::dvec3 normal, int bounces, int paths) {
        glm::dvec3 sum(0);
        for (int i = 0; i < paths; ++i)
            sum += path(position, normal, bounces);
        return sum / static_cast<double>(paths);
    }

private:
    struct Triangle {
        glm::dvec3 a, b, c, albedo;
    };

    glm::dvec3 path(glm::dvec3 position, glm::dvec3 normal, int bounces) {
        glm::dvec3 weight(1);
        for (int k = 0;; ++k) {
            const double u = unit_(random_), phi = 2 * pi * unit_(random_), r = std::sqrt(u);
            const glm::dvec3 side = glm::normalize(
                glm::cross(normal, std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
            const glm::dvec3 direction = r * std::cos(phi) * side +
                                         r * std::sin(phi) * glm::cross(normal, side) +
                                         std::sqrt(1 - u) * normal;
            double nearest = 1e30;
            const Triangle* hit = nullptr;
            for (const Triangle& t : triangles_) {
                const glm::dvec3 ab = t.b - t.a, ac = t.c - t.a, s = position - t.a,
                                 q = glm::cross(direction, ac);
                const double determinant = glm::dot(ab, q);
                if (std::abs(determinant) < 1e-14)
                    continue;
                const double b = glm::dot(s, q) / determinant;
                const glm::dvec3 w = glm::cross(s, ab);
                const double c = glm::dot(direction, w) / determinant, d = glm::dot(ac, w) / determinant;
                if (b >= 0 && c >= 0 && b + c <= 1 && d > 1e-9 && d < nearest) {
                    nearest = d;
                    hit = &t;
                }
            }
            if (!hit)
                return weight;
            const glm::dvec3 face = glm::normalize(glm::cross(hit->b - hit->a, hit->c - hit->a));
            if (k == bounces || glm::dot(face, direction) > 0)
                return glm::dvec3(0);
            weight *= hit->albedo;
            position += nearest * direction;
            normal = face;
        }
    }

    std::vector<Triangle> triangles_;
    std::mt19937_64 random_{11};
    std::uniform_real_distribution<double> unit_{0, 1};
};

TEST(ColorBleeding, MatchesPathTracing) {
    const float h = 1;
    const auto fine = [](const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v) {
        SceneBuilder builder;
        constexpr int kCells = 24;
        const auto at = [&](int i, int j) {
            return corner + u * (static_cast<float>(i) / kCells) + v * (static_cast<float>(j) / kCells);
        };
        for (int i = 0; i < kCells; ++i)
            for (int j = 0; j < kCells; ++j)
                builder.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        return builder.build();
    };
    const glm::vec3 red(0.9f, 0.2f, 0.1f), white(0.8f);
    const glm::vec3 x(2 * h, 0, 0), y(0, 2 * h, 0), z(0, 0, 2 * h), corner(-h, 0, -h);
    const Scene scene =
        test::join({test::painted(fine(corner, z, x), white), test::painted(fine(corner, y, z), red)});
    // The same geometry with two triangles per side for the path tracer, which tests all triangles.
    const auto coarse = [](const glm::vec3& c, const glm::vec3& u, const glm::vec3& v) {
        return SceneBuilder().quad(c, c + u, c + u + v, c + v).build();
    };
    BouncedPaths tracer(
        test::join({test::painted(coarse(corner, z, x), white), test::painted(coarse(corner, y, z), red)}));

    const BakeResult result = bake_bounces(scene, 3, 4096);
    ASSERT_EQ(result.baked.transfer.layout.channels(), 3);
    const auto radiance = under_uniform_light(result.baked.transfer);
    int compared = 0;
    for (std::size_t p = 0; p < scene.vertex_arrays[0].size(); p += 211) {
        const glm::vec3 position = scene.vertex_arrays[0].positions[p];
        if (position.x <
            -h + 0.15f) // next to the wall the first vertices of the floor see it at grazing angles
            continue;
        const glm::dvec3 expected = tracer.radiance(glm::dvec3(position), {0, 1, 0}, 3, 60000);
        for (int c = 0; c < 3; ++c) // four standard deviations of the walks
            EXPECT_NEAR(static_cast<double>(radiance[p][c]), expected[c], 4 * 0.45 / std::sqrt(60000.0)) << p;
        ++compared;
    }
    EXPECT_GE(compared, 8);
    const glm::vec3 near = radiance[6 * 24 * 2]; // next to the wall, in the middle of the floor's edge
    EXPECT_GT(near.r, near.b + 0.02f);
}

TEST(HitPoint, UsesVaryingTriangleProperties) {
    for (const test::Varying varying : test::kAllVarying) {
        const test::BounceError error = test::bounce_off_triangle(varying, Backend::cpu);
        EXPECT_LT(error.baked, 0.01) << varying; // 4 096 rays, codes of 8 bits
        EXPECT_GT(error.swapped, 0.05) << varying;
    }
}

TEST(Bounces, AreByteIdenticalForAllThreadCounts) {
    BakeOptions options;
    options.rays = 300;
    options.bounces = 2;
    options.tracer.backend = Backend::cpu;
    options.threads = 1;
    const Scene scene = make_bowl(0.5).scene;
    const auto one = bake(scene, options).baked.transfer.vectors;
    options.threads = 3;
    EXPECT_EQ(one, bake(scene, options).baked.transfer.vectors);
}

TEST(Bounces, ConvergeForAlbedosAboveOne) {
    // Nearly closed, and white by the clamp: under uniform light 1 the exit radiance is 1 for any number of
    // bounces.
    const Scene bowl = SceneBuilder().bowl({0, 0, 0}, 1, 8, 2).build();
    test::GlbFile file = test::scene_file(bowl);
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1.2, 1.5, 3, 1}}}}}};
    primitive["attributes"]["COLOR_0"] =
        file.accessor(std::vector<float>(3 * bowl.receivers(), 1.2f), test::kFloat, "VEC3", 3);
    const std::string bytes = file.bytes();
    const Scene scene = extract_scene(parse_gltf(std::as_bytes(std::span(bytes)), "bowl.glb"));
    const BakeResult result = bake_bounces(scene, kEndlessBounces, 256);
    EXPECT_EQ(result.baked.transfer.layout.channels(), 1);
    const std::vector<float> areas = receiver_areas(scene);
    const auto radiance = under_uniform_light(result.baked.transfer);
    for (std::size_t p = 0; p < radiance.size(); ++p) {
        if (areas[p] > 0) {
            EXPECT_NEAR(static_cast<double>(radiance[p].x), 1, 2e-3) << p;
        }
    }
}

TEST(Bounces, AreSkippedWithoutScattering) {
    const Scene black = test::painted(SceneBuilder().bowl({0, 0, 0}, 1, 8, 2).build(), glm::vec3(0));
    const BakeResult result = bake_bounces(black, kEndlessBounces, 64);
    EXPECT_EQ(result.baked.record.bounces, 0);
    ASSERT_FALSE(result.statistics.notices.empty());
    EXPECT_NE(result.statistics.notices[0].find("black"), std::string::npos);
    // No bounces: a single floor.
    const BakeResult floor = bake_bounces(SceneBuilder().floor({0, 0, 0}, 1).build(), 3, 64);
    EXPECT_EQ(floor.baked.record.bounces, 0);
    EXPECT_EQ(floor.statistics.gather.entries, 0u);
}

TEST(Channels, AreThreeOnlyForColoredBounces) {
    const Scene grey = make_bowl(0.5).scene;
    const Scene red = test::painted(grey, {0.9f, 0.1f, 0.1f});
    EXPECT_EQ(bake_bounces(grey, 1, 64).baked.transfer.layout.channels(), 1);
    EXPECT_EQ(bake_bounces(red, 0, 64).baked.transfer.layout.channels(), 1);
    EXPECT_EQ(bake_bounces(red, 1, 64).baked.transfer.layout.channels(), 3);
}

TEST(BackFaces, ReflectIfDoubleSidedAndBlockOtherwise) {
    // A small roof that faces up over a floor: from below only its back is seen.
    const auto radiance = [](bool double_sided) {
        const Scene scene = test::painted(test::join({SceneBuilder().floor({0, 0, 0}, 1, 10).build(),
                                                      SceneBuilder().floor({0, 0.5f, 0}, 0.25f, 4).build()}),
                                          glm::vec3(0.8f), double_sided);
        const Transfer t = bake_bounces(scene, 2).baked.transfer;
        return under_uniform_light(t)[10 * 5 * 6 + 5 * 6].x; // the middle of the floor
    };
    EXPECT_GT(radiance(true), radiance(false) + 0.03f);
}

TEST(Memory, IsEstimatedFirstAndLimited) {
    BakeOptions options;
    options.order = 10;
    EXPECT_GT(estimate_memory(options, 100'000'000, 200'000'000, 100), 1.2e11);
    options.bounces = 1;
    options.memory.limit = 20e6;
    options.tracer.backend = Backend::cpu;
    try {
        bake(make_bowl(0.5).scene, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("the limit is 0.02 GB"), std::string::npos) << error.what();
    }
}

TEST(Memory, BouncesCountActualHits) {
    // A lamp's shade over a floor: one ray in fifty meets something, and one in four is followed.
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 1, 40).floor({0, 0.5f, 0}, 0.1f).build();
    BakeOptions options;
    options.order = 2;
    options.rays = 2048;
    options.bounces = 1;
    options.tracer.backend = Backend::cpu;
    options.memory.limit = 50e6; // a third of the memory for 9 600 · 2 048 entries
    EXPECT_NO_THROW(bake(scene, options));
}

TEST(Memory, ContainersHaveTheirSmallestLimit) {
    const test::TemporaryFolder folder;
    const auto write = [&](const char* name, const char* text) {
        std::filesystem::create_directories((folder.path() / name).parent_path());
        std::ofstream(folder.path() / name) << text;
    };
    const auto limit = [&] {
        return control_group_limit(folder.path() / "membership", folder.path() / "mounted");
    };
    EXPECT_TRUE(std::isinf(limit()));
    write("membership", "0::/farm/job\n");
    write("mounted/farm/job/memory.max", "max\n");
    EXPECT_TRUE(std::isinf(limit()));
    write("mounted/farm/memory.max", "8000000000\n"); // limit of the parent group
    EXPECT_EQ(limit(), 8e9);
    write("mounted/farm/job/memory.max", "2000000000\n");
    EXPECT_EQ(limit(), 2e9);
    write("membership", "3:cpu:/\n5:memory:/job\n"); // version 1
    write("mounted/memory/job/memory.limit_in_bytes", "3000000000\n");
    EXPECT_EQ(limit(), 3e9);
}

} // namespace
} // namespace prt

// Voxels against what they stand in for: closed forms, and rays.

#include "far/blocker_volume.h"
#include "far/far_error.h"
#include "prt/bake.h"
#include "prt/sh_basis.h"
#include "prt/support/tangent_frame.h"
#include "support/scene_builder.h"
#include "trace/embree_tracer.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace prt {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Small equilateral triangles of `area` anywhere in a box, facing anywhere or up.
Scene leaves(int count, float area, const glm::vec3& low, const glm::vec3& high, bool level, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    const float side = std::sqrt(4 * area / std::numbers::sqrt3_v<float>);
    test::SceneBuilder builder;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 at = low + (high - low) * glm::vec3{unit(random), unit(random), unit(random)};
        const float z = level ? 1 : 1 - 2 * unit(random), turn = 2 * std::numbers::pi_v<float> * unit(random);
        const float ring = std::sqrt(std::max(0.0f, 1 - z * z));
        const glm::vec3 normal(ring * std::cos(turn), z, ring * std::sin(turn));
        const glm::vec3 aside = glm::normalize(
            glm::cross(normal, std::abs(normal.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
        const glm::vec3 up = glm::cross(aside, normal);
        const float height = 0.5f * std::numbers::sqrt3_v<float> * side;
        builder.triangle(at - 0.5f * side * aside - height / 3 * up,
                         at + 0.5f * side * aside - height / 3 * up, at + 2 * height / 3 * up);
    }
    return builder.build();
}

DenseParts all_dense(const Scene& scene) {
    return find_dense_parts(scene, 8);
}

TEST(Extinction, IsBandsZeroAndTwoOfFlatPieces) {
    // Projections of |cos|, whose integrals are pi Y00 .. by quadrature over the sphere.
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, -0.7f, 0.5f));
    Extinction extinction;
    extinction.add(normal, 2);
    std::array<double, 9> of_pieces{}, of_voxel{};
    constexpr int kRings = 200, kTurns = 400;
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kTurns; ++j) {
            const double z = 1 - 2 * (i + 0.5) / kRings, turn = 2 * std::numbers::pi * (j + 0.5) / kTurns,
                         ring = std::sqrt(1 - z * z);
            const glm::dvec3 w(ring * std::cos(turn), ring * std::sin(turn), z);
            std::array<double, 9> y;
            sh_basis<3>(w.x, w.y, w.z, y.data());
            for (std::size_t k = 0; k < 9; ++k) {
                of_pieces[k] += y[k] * 2 * std::abs(glm::dot(w, glm::dvec3(normal)));
                of_voxel[k] += y[k] * static_cast<double>(extinction.along(glm::vec3(w)));
            }
        }
    for (std::size_t k = 0; k < 9; ++k)
        EXPECT_NEAR(of_voxel[k] / of_pieces[0], of_pieces[k] / of_pieces[0], 1e-4) << k;
}

/// Of rays along an axis through the middle of a box from 0 to 2.
double mean_passed(const BlockerVolume& volume, int axis, std::mt19937& random) {
    constexpr int kRays = 400;
    std::uniform_real_distribution<float> unit(0.1f, 1.9f);
    double mean = 0;
    for (int i = 0; i < kRays; ++i) {
        glm::vec3 origin{unit(random), unit(random), unit(random)}, direction(0);
        origin[axis] = -1;
        direction[axis] = 1;
        mean += static_cast<double>(volume.passes(origin, direction, 0, kInfinity)) / kRays;
    }
    return mean;
}

TEST(BlockerVolume, OfLeavesIsTheLawOfBeerAndLambert) {
    // 12 000 leaves of 6 cm² in 2 x 2 x 2 m: extinction 12 000 · 0.0006 / 8 / 2 = 0.45 a metre.
    const Scene scene = leaves(12000, 0.0006f, glm::vec3(0), glm::vec3(2), false, 5);
    const TraceScene traced(scene);
    const BlockerVolume volume(traced, all_dense(scene), 0.25f);
    std::mt19937 random(2);
    for (int axis = 0; axis < 3; ++axis) // 5 400 leaves that a beam of 3.2 m² meets: 1.4 %
        EXPECT_NEAR(mean_passed(volume, axis, random), std::exp(-0.9), 0.02) << axis;
}

TEST(BlockerVolume, OfLevelLeavesStopsMostFromAbove) {
    const Scene scene = leaves(12000, 0.0006f, glm::vec3(0), glm::vec3(2), true, 5);
    const TraceScene traced(scene);
    const BlockerVolume volume(traced, all_dense(scene), 0.25f);
    std::mt19937 random(3);
    const double from_above = mean_passed(volume, 1, random), from_aside = mean_passed(volume, 0, random);
    // Bands 0 and 2 of |cos| are 9/8 along the normal and 3/16 across it, instead of 1 and 0.
    EXPECT_NEAR(-std::log(from_above), 1.8, 0.25);
    EXPECT_NEAR(-std::log(from_aside), 0.3, 0.1);
}

TEST(BlockerVolume, OfABallStopsAsMuchAsItsDisc) {
    const Scene scene = test::SceneBuilder().sphere({0, 0, 0}, 1, 24).build();
    const TraceScene traced(scene);
    const BlockerVolume volume(traced, all_dense(scene), 0.25f);
    for (const glm::vec3& direction : {glm::vec3(0, 0, 1), glm::vec3(0, -1, 0), glm::vec3(0.6f, 0, 0.8f)}) {
        const TangentFrame frame = tangent_frame(direction);
        double stopped = 0, inside = 0;
        int count = 0;
        for (int i = -40; i < 40; ++i)
            for (int j = -40; j < 40; ++j) {
                const glm::vec2 at = 0.04f * (glm::vec2(i, j) + 0.5f);
                const float stops =
                    1 - volume.passes(at.x * frame.tangent + at.y * frame.bitangent - 5.0f * direction,
                                      direction, 0, kInfinity);
                stopped += static_cast<double>(stops) * 0.04 * 0.04;
                const float radius = glm::length(at);
                if (radius < 0.75f) {
                    inside += static_cast<double>(stops);
                    ++count;
                }
                // What is farther off its outline than a voxel's diagonal stops nothing.
                ASSERT_TRUE(radius < 1.44f || stops == 0) << radius;
            }
        EXPECT_NEAR(stopped / std::numbers::pi, 1, 0.03);
        EXPECT_GT(inside / count,
                  0.85); // rays see voxels along the outline half as dense as those in the middle
    }
}

TEST(BlockerVolume, EndsOfRaysAreOnSurfacesThatFaceThem) {
    const Scene scene = test::SceneBuilder().sphere({0, 0, 0}, 1, 24).build();
    const TraceScene traced(scene);
    const BlockerVolume volume(traced, all_dense(scene), 0.25f);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0, 1);
    int back = 0;
    double depth = 0;
    constexpr int kRays = 2000;
    for (int i = 0; i < kRays; ++i) {
        const glm::vec3 origin(unit(random) - 0.5f, unit(random) - 0.5f, -5), direction(0, 0, 1);
        const float stopped = 1 - volume.passes(origin, direction, 0, kInfinity);
        ASSERT_GT(stopped, 0.5f);
        const BlockerVolume::Met met = volume.end_of(origin, direction, 0, stopped, unit(random));
        back += met.hit.back;
        EXPECT_LT(met.hit.triangle, scene.triangles());
        EXPECT_GT(met.distance, 3.5f);
        EXPECT_LT(met.distance, 6.5f);
        depth += static_cast<double>(met.distance) / kRays;
    }
    EXPECT_LT(back, kRays / 20);
    EXPECT_NEAR(depth, 4.08, 0.5); // of the ball's near side, within two voxels
}

/// A floor, with balls of leaves on it as nodes of their own.
Scene grove(int balls) {
    std::vector<Scene> parts = {test::SceneBuilder().floor({0, 0, 0}, 20, 20).build()};
    for (int i = 0; i < balls; ++i) {
        const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(balls);
        const glm::vec3 at(10 * std::cos(turn), 1.2f, 10 * std::sin(turn));
        parts.push_back(leaves(900, 0.01f, at - 1.0f, at + 1.0f, false, static_cast<unsigned>(i)));
    }
    Scene scene = test::join(parts);
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        scene.primitives[p].node = static_cast<int>(p);
    return scene;
}

TEST(FarBlockers, AreNodesThatAreSmallAndOfManyTriangles) {
    const Scene scene = grove(3);
    const DenseParts near = find_dense_parts(scene, 5);
    EXPECT_EQ(near.nodes.size(), 3u);
    EXPECT_EQ(near.triangles, 2700u);
    EXPECT_EQ(near.primitives, (std::vector<bool>{false, true, true, true}));
    EXPECT_EQ(find_dense_parts(scene, 3).nodes.size(), 0u) << "too large for so near";
}

TEST(FarBlockers, AreNoWalls) {
    Scene wall = test::SceneBuilder().floor({0, 0, 0}, 1, 8).build();
    EXPECT_EQ(find_dense_parts(wall, 5).triangles, 0u);
}

TEST(FarBlockers, TellWhatTheyLetIntoTheDark) {
    // A shut box of thick walls: balls of many triangles, side by side and larger than the gaps between them.
    std::vector<Scene> parts = {test::SceneBuilder().floor({0, 0, 0}, 0.5f, 1).build()};
    for (int i = 0; i < 200; ++i) { // on a sphere, by turns of the golden angle
        const float z = 1 - (2 * static_cast<float>(i) + 1) / 200, turn = 2.39996f * static_cast<float>(i),
                    ring = std::sqrt(1 - z * z);
        parts.push_back(
            test::SceneBuilder()
                .sphere(8.0f * glm::vec3(ring * std::cos(turn), ring * std::sin(turn), z), 1.3f, 8)
                .build());
    }
    Scene scene = test::join(parts);
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        scene.primitives[p].node = static_cast<int>(p);
    const TraceScene traced(scene);
    const Receivers receivers = vertex_receivers(scene);
    const std::vector<std::uint32_t> inside = {0, 1, 2, 3};
    EmbreeTracer tracer(traced, 6);
    const std::optional<FarBlockerFigures> figures = far_figures(tracer, traced, receivers, inside, 3);
    ASSERT_GT(figures->voxels, 100u);
    EXPECT_GT(figures->error, 0.1) << "no light arrives, so that any is wrong";
}

TEST(FarBlockers, ChangeNothingWhereNothingIsDense) {
    const Scene scene =
        test::join({test::SceneBuilder().floor({0, 0, 0}, 8, 4).build(),
                    test::SceneBuilder().quad({-1, 3, -1}, {-1, 3, 1}, {1, 3, 1}, {1, 3, -1}).build()});
    BakeOptions options;
    options.order = 4;
    options.rays = 256;
    options.bounces = 2;
    options.tracer.backend = Backend::cpu;
    const BakeResult without = bake(scene, options);
    options.tracer.far_distance = 2;
    const BakeResult with = bake(scene, options);
    ASSERT_TRUE(with.far);
    EXPECT_EQ(with.far->voxels, 0u);
    EXPECT_EQ(with.far->error, 0);
    EXPECT_EQ(without.far, std::nullopt);
    ASSERT_EQ(with.baked.transfer.vectors.size(), without.baked.transfer.vectors.size());
    for (std::size_t i = 0; i < with.baked.transfer.vectors.size(); ++i)
        ASSERT_NEAR(with.baked.transfer.vectors[i], without.baked.transfer.vectors[i], 1e-6f);
}

TEST(FarBlockers, ErrLessTheFartherTheyAre) {
    const Scene scene = grove(12);
    const TraceScene traced(scene);
    const Receivers receivers = vertex_receivers(scene);
    const std::vector<std::uint32_t> indices = receivers_on_surfaces(receivers);
    std::vector<double> errors;
    for (const double distance : {4.0, 8.0, 100.0}) {
        EmbreeTracer tracer(traced, distance);
        errors.push_back(far_figures(tracer, traced, receivers, indices, 5)->error);
    }
    EXPECT_LT(errors[0], 0.03);
    EXPECT_LT(errors[1], errors[0]);
    EXPECT_EQ(errors[2], 0) << "beyond all";
    EmbreeTracer plain(traced);
    EXPECT_FALSE(far_figures(plain, traced, receivers, indices, 5));
}

TEST(FarBlockers, HitsStandForAllThatIsBlocked) {
    const Scene scene = grove(12);
    const TraceScene traced(scene);
    EmbreeTracer tracer(traced, 4);
    const Receivers receivers = vertex_receivers(scene);
    const std::vector<std::uint32_t> indices = {0, 50, 100, 200, 300, 400};
    const TraceOptions options{.order = 1, .rays = 1024, .hit_stride = 8};
    std::vector<float> vectors(indices.size());
    std::vector<double> blocked(indices.size());
    tracer.trace(receivers, indices, options, vectors, [&](std::size_t i, std::span<const Hit> hits) {
        for (const Hit& hit : hits)
            blocked[i] += static_cast<double>(hit.weight);
    });
    EXPECT_GT(std::accumulate(blocked.begin(), blocked.end(), 0.0), 10);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        EXPECT_NEAR(1 - blocked[i] / options.rays, static_cast<double>(vectors[i]) / kY00, 1e-4) << i;
    }
}

TEST(FarBlockers, AFurnaceStaysAFurnace) {
    const Scene scene = test::painted(grove(6), glm::vec3(1), true);
    BakeOptions options;
    options.order = 2;
    options.rays = 512;
    options.bounces = kEndlessBounces;
    options.tracer.backend = Backend::cpu;
    options.tracer.far_distance = 4;
    const BakeResult baked = bake(scene, options);
    ASSERT_GT(baked.far->voxels, 10u);
    const Transfer& transfer = baked.baked.transfer;
    for (std::size_t r = 0; r < transfer.receivers(); ++r) {
        double light = 0;
        for (std::size_t i = 0; i < transfer.dimension(); i += 4)
            light += static_cast<double>(transfer.vector(r)[i]) / kY00;
        ASSERT_NEAR(light, 1, 2e-3) << r;
    }
}

} // namespace
} // namespace prt

// Tests transfer of texels: closed forms, energy, and scenes that cannot be baked into texels.

#include "bake/products/lightmaps/unwrap.h"
#include "bake/scene/receivers.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/sh.h"
#include "texel_scenes.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

namespace prt {
namespace {

using test::beside_map;
using test::floor_map;
using test::of_one_texel;
using test::options_of;
using test::SceneBuilder;
using test::whole;

double sum_of(std::span<const float> values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(LightmapBake, OpenFloorHasTheLobeOfItsNormal) {
    const Scene scene = floor_map(SceneBuilder().floor({0, 0, 0}, 1).build());
    const LightmapBake baked = bake_lightmap(scene, {whole(scene, 8)}, options_of(4, 4096, 0));
    const BakedLightmap& map = baked.lightmap;
    const Transfer truth = unshadowed_transfer(scene, 4);
    EXPECT_EQ(map.texels.size(), 64u);
    EXPECT_NEAR(sum_of(map.areas), 4, 1e-4); // m²
    for (std::size_t t = 0; t < map.texels.size(); ++t)
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_NEAR(map.baked.transfer.vector(t)[i], truth.vector(0)[i], 3e-3) << t << " " << i;
}

/// A floor that fills its map, with a wall along its edge at x = -1, as good as endless.
struct WalledFloor {
    static constexpr double kHeight = 0.5;
    Scene scene;
    std::vector<Atlas> atlases;

    explicit WalledFloor(int size) {
        constexpr float kFar = 1000, kTop = static_cast<float>(kHeight);
        const Scene wall =
            SceneBuilder().quad({-1, 0, kFar}, {-1, 0, -kFar}, {-1, kTop, -kFar}, {-1, kTop, kFar}).build();
        scene = floor_map(test::join({SceneBuilder().floor({0, 0, 0}, 1).build(), wall}));
        VertexArray& of_wall = scene.vertex_arrays[1];
        for (std::size_t v = 0; v < of_wall.size(); ++v) {
            const glm::vec3& p = of_wall.positions[v];
            of_wall.texcoords[0][v] = {p.z > 0 ? 1 : 0, p.y / kTop};
        }
        atlases.resize(2);
        for (std::size_t a = 0; a < 2; ++a) {
            atlases[a].primitives = {a};
            atlases[a].uv_set = 0;
            atlases[a].width = atlases[a].height = a == 0 ? size : 2;
        }
    }
    /// Returns the cosine-weighted visible fraction of the sky at distance d from the wall: 1 - (1 -
    /// cos(elevation of its top)) / 2.
    static double visibility(double d) { return (1 + d / std::hypot(d, kHeight)) / 2; }
};

/// Root mean square error over the floor of bilinear lookups. The mean product of the errors of two bakes
/// with independent noise is their common error.
struct LookupErrors {
    double all = 0;    ///< over the whole floor
    double inside = 0; ///< more than half a texel from its edges, where filters have no data beyond
};
LookupErrors lookup_errors(int size, int rays) {
    const WalledFloor floor(size);
    BakeOptions options = options_of(1, rays, 0);
    std::vector<float> seen[2];
    for (std::size_t i = 0; i < 2; ++i) {
        options.seed = i + 1;
        const BakedLightmap map = bake_lightmap(floor.scene, floor.atlases, options).lightmap;
        for (std::uint32_t t = 0; t < static_cast<std::uint32_t>(size * size); ++t) {
            EXPECT_EQ(map.texels[t], t);
            seen[i].push_back(map.baked.transfer.vector(t)[0] / 0.28209479f);
        }
    }
    constexpr int kPositions = 4; // along a texel
    double sums[2] = {}, points[2] = {};
    for (int y = 0; y < kPositions * size; ++y)
        for (int x = 0; x < kPositions * size; ++x) {
            const glm::dvec2 point = (glm::dvec2(x, y) + 0.5) / static_cast<double>(kPositions);
            const BilinearTexels filter = bilinear_texels({size, size}, point.x, point.y);
            double product = 1;
            for (const std::vector<float>& values : seen) {
                double error = -WalledFloor::visibility(point.x * 2 / size);
                for (std::size_t k = 0; k < 4; ++k)
                    error += filter.weights[k] * static_cast<double>(values[filter.texels[k]]);
                product *= error;
            }
            const bool inside = std::min(point.x, point.y) > 0.5 && std::max(point.x, point.y) < size - 0.5;
            for (int i = 0; i <= (inside ? 1 : 0); ++i) {
                sums[i] += product;
                points[i] += 1;
            }
        }
    return {std::sqrt(std::abs(sums[0] / points[0])), std::sqrt(std::abs(sums[1] / points[1]))};
}

TEST(LightmapBake, ConvergesToTheClosedForm) {
    // Means over texels and lines between them err by the square of a texel: a quarter for half its side. In
    // the half texel along edges filters repeat the last, and err by a texel's side on a share of the floor
    // as large: half of it to the power 3/2 for the root mean square, 0.35.
    LookupErrors coarse = lookup_errors(8, 1 << 16);
    for (const int size : {16, 32, 64}) {
        const LookupErrors fine = lookup_errors(size, (1 << 22) / (size * size));
        EXPECT_LT(fine.all, 0.4 * coarse.all) << size;
        EXPECT_LT(fine.inside, 0.33 * coarse.inside) << size;
        coarse = fine;
    }
    // Measured: 0.00079 and 0.00006; bakes resolve errors down to 0.0001.
    EXPECT_LT(coarse.all, 1e-3);
    EXPECT_LT(coarse.inside, 2e-4);
}

TEST(LightmapBake, LampLightFollowsTheInverseSquareLaw) {
    Scene scene = floor_map(SceneBuilder().floor({0, 0, 0}, 1).build());
    scene.lights.push_back({.name = "lamp", .intensity = glm::vec3(3), .position = {0.3f, 0.7f, -0.2f}});
    const LightmapBake baked = bake_lightmap(scene, {whole(scene, 32)}, options_of(1, 64, 0));
    const TransferLayout& layout = baked.lightmap.baked.transfer.layout;
    ASSERT_EQ(layout.lamps(), 1u);
    for (std::size_t t = 0; t < baked.lightmap.texels.size(); ++t) {
        const std::uint32_t texel = baked.lightmap.texels[t];
        const std::uint32_t row = texel / 32;
        const glm::dvec3 point((texel % 32 + 0.5) / 16 - 1, 0, (row + 0.5) / 16 - 1);
        const glm::dvec3 way = glm::dvec3(0.3, 0.7, -0.2) - point;
        const double squared = glm::dot(way, way);
        const double radiance = 3 * way.y / (squared * std::sqrt(squared)) / std::numbers::pi;
        // The mean over a texel of a sixteenth of a metre differs from its middle by its curvature.
        EXPECT_NEAR(baked.lightmap.baked.transfer.vector(t).back(), radiance, 0.01 * radiance);
    }
}

/// A scene in which each triangle has a separate chart in a map.
struct Charted {
    Scene scene;
    std::vector<Atlas> atlases;

    Charted(Scene plain, int size) : scene(std::move(plain)) {
        Unwrapping unwrapping = unwrap(scene, {.size = size});
        for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
            VertexArray& vertices = scene.vertex_arrays[scene.primitives[p].vertices];
            const VertexSplit& split = unwrapping.primitives[p];
            VertexArray after;
            for (const std::uint32_t v : split.source) {
                after.positions.push_back(vertices.positions[v]);
                after.normals.push_back(vertices.normals[v]);
            }
            after.texcoords = {split.uv};
            vertices = std::move(after);
            scene.primitives[p].triangles = split.triangles;
        }
        std::size_t first = 0;
        for (VertexArray& vertices : scene.vertex_arrays) {
            vertices.first_receiver = first;
            first += vertices.size();
        }
        atlases = std::move(unwrapping.atlases);
        for (Atlas& atlas : atlases)
            atlas.uv_set = 0;
    }
};

TEST(LightmapBake, WithAllBouncesOfWhiteSurfacesIsOneEverywhere) {
    const Charted bowl(test::painted(SceneBuilder().bowl({0, 0, 0}, 1, 12, 3).build(), glm::vec3(1)), 96);
    const LightmapBake baked = bake_lightmap(bowl.scene, bowl.atlases, options_of(2, 256, kEndlessBounces));
    const Transfer& t = baked.lightmap.baked.transfer;
    EXPECT_GT(baked.statistics.sources, 0u);
    const std::vector<glm::vec3> radiance = exit_radiance(t, constant_light(2, glm::vec3(1)));
    for (std::size_t p = 0; p < radiance.size(); ++p)
        if (baked.lightmap.areas[p] > 0) {
            EXPECT_NEAR(radiance[p].r, 1, 2e-3) << p;
        }
}

TEST(LightmapBake, SeamEdgesMatchStitching) {
    const Charted bowl(SceneBuilder().bowl({0, 0, 0}, 1, 6, 2).build(), 96);
    const LightmapBake baked = bake_lightmap(bowl.scene, bowl.atlases, options_of(2, 64, 0));
    const BakedLightmap& map = baked.lightmap;
    const std::vector<SeamJump> jumps = seam_jumps(bowl.scene, map.layout, map.texels);
    ASSERT_GT(jumps.size(), 0u);
    double squared = 0;
    for (const SeamJump& jump : jumps) {
        EXPECT_NEAR(sum_of(jump.weights), 0, 1e-6);
        double value = 0;
        for (std::size_t i = 0; i < 8; ++i)
            value += static_cast<double>(jump.weights[i] * map.baked.transfer.vector(jump.receivers[i])[0] /
                                         0.28209479f);
        squared += value * value;
    }
    EXPECT_NEAR(std::sqrt(squared / static_cast<double>(jumps.size())), baked.statistics.seam, 1e-5);
    EXPECT_GT(baked.statistics.seam_before, 1e-3);
}

TEST(LightmapBake, BouncesLikeVertices) {
    // A wall next to a floor, both finely divided: at vertices of the floor both bakes agree.
    const Scene wall = SceneBuilder()
                           .floor({0, 0, 0}, 1, 16)
                           .transform([](const glm::vec3& p) { return glm::vec3(-1, p.x + 1, p.z); })
                           .build();
    const auto joined = [&](const Scene& floor) {
        return test::join(
            {test::painted(floor, glm::vec3(0.5f)), test::painted(wall, {0.8f, 0.2f, 0.1f}, true)});
    };
    Charted fine(joined(SceneBuilder().floor({0, 0, 0}, 1, 16).build()), 256);
    BakeOptions options = options_of(3, 4096, 2);
    options.fit = FitMode::vertex;
    const Transfer vertices = bake(fine.scene, options).baked.transfer;
    const LightmapBake texels = bake_lightmap(fine.scene, fine.atlases, options);
    double error = 0, norm = 0;
    const VertexArray& floor = fine.scene.vertex_arrays[0];
    for (std::size_t v = 0; v < floor.size(); ++v) {
        const glm::vec3& p = floor.positions[v];
        if (p.y != 0 || std::max(std::abs(p.x), std::abs(p.z)) > 0.9f)
            continue;
        const std::vector<float> here = test::lookup(texels.lightmap, floor.texcoords[0][v]);
        for (std::size_t i = 0; i < vertices.dimension(); ++i) {
            const auto value = static_cast<double>(here[i]);
            const auto truth = static_cast<double>(vertices.vector(v)[i]);
            error += (value - truth) * (value - truth);
            norm += truth * truth;
        }
    }
    ASSERT_GT(norm, 0);
    EXPECT_LT(std::sqrt(error / norm), 0.02); // texels have a quarter of the rays at each of four positions
}

TEST(LightmapBake, DoesNotDependOnThreads) {
    const Charted bowl(test::painted(SceneBuilder().bowl({0, 0, 0}, 1, 6, 2).build(), {0.7f, 0.4f, 0.2f}),
                       48);
    BakeOptions one = options_of(3, 64, 2), three = one;
    one.threads = 1;
    three.threads = 3;
    EXPECT_EQ(bake_lightmap(bowl.scene, bowl.atlases, one).lightmap.baked.transfer.vectors,
              bake_lightmap(bowl.scene, bowl.atlases, three).lightmap.baked.transfer.vectors);
}

/// Returns the distance for all light of a sky, direct and bounced, because their noise compensates.
double relative_distance(const Transfer& truth, const Transfer& x) {
    const auto columns = static_cast<std::size_t>(coefficient_count(truth.layout.order));
    double error = 0, norm = 0;
    for (std::size_t p = 0; p < truth.receivers(); ++p)
        for (std::size_t c = 0; c < columns; ++c) {
            double here = 0, there = 0;
            for (std::size_t i = c; i < truth.dimension(); i += columns) {
                here += static_cast<double>(x.vector(p)[i]);
                there += static_cast<double>(truth.vector(p)[i]);
            }
            error += (here - there) * (here - there);
            norm += there * there;
        }
    return std::sqrt(error / norm);
}

/// Tests that the filter reduces noise, loses little without noise, and that the estimate is that of the
/// remaining noise.
TEST(LightmapBake, FiltersNoise) {
    const Scene floor = floor_map(SceneBuilder().floor({0, 0, 0}, 1, 4).build());
    const Scene scene = test::painted(
        beside_map(floor, SceneBuilder().sphere({0, 0.5f, 0}, 0.4f, 12).build()), glm::vec3(0.7f));
    const std::vector<Atlas> atlases{whole(floor, 64), of_one_texel()};
    const auto baked = [&](int rays, std::uint64_t seed, bool denoise) {
        BakeOptions options = options_of(3, rays, 1);
        options.seed = seed;
        options.repairs.denoise = denoise;
        return bake_lightmap(scene, atlases, options);
    };
    const Transfer truth = baked(1 << 12, 9, false).lightmap.baked.transfer;
    const LightmapBake filtered = baked(64, 1, true);
    const double before = relative_distance(truth, baked(64, 1, false).lightmap.baked.transfer),
                 after = relative_distance(truth, filtered.lightmap.baked.transfer);
    EXPECT_LT(after, 0.6 * before) << before;
    EXPECT_TRUE(filtered.statistics.denoised);
    EXPECT_NEAR(filtered.statistics.sampling_error, after, 0.35 * after);
    EXPECT_LT(relative_distance(truth, baked(1 << 10, 2, true).lightmap.baked.transfer),
              1.02 * relative_distance(truth, baked(1 << 10, 2, false).lightmap.baked.transfer));
}

/// Two floors side by side in a map and in space, one of them under a low ceiling: two surfaces.
TEST(LightmapBake, FiltersNoLightFromOneSurfaceToAnother) {
    const auto floor = [](float low, float high) {
        return SceneBuilder().quad({low, 0, 1}, {high, 0, 1}, {high, 0, -1}, {low, 0, -1}).build();
    };
    SceneBuilder cover; // over the right floor, closed on all sides
    cover.quad({0, 0.3f, -1}, {1, 0.3f, -1}, {1, 0.3f, 1}, {0, 0.3f, 1});
    cover.quad({0, 0, -1}, {0, 0.3f, -1}, {0, 0.3f, 1}, {0, 0, 1});
    cover.quad({1, 0, 1}, {1, 0.3f, 1}, {1, 0.3f, -1}, {1, 0, -1});
    cover.quad({0, 0, 1}, {0, 0.3f, 1}, {1, 0.3f, 1}, {1, 0, 1});
    cover.quad({1, 0, -1}, {1, 0.3f, -1}, {0, 0.3f, -1}, {0, 0, -1});
    const Scene floors = floor_map(test::join({floor(-1, 0), floor(0, 1)})),
                scene = beside_map(floors, cover.build());
    BakeOptions options = options_of(2, 16, 0);
    options.repairs.inside = Inside::keep;
    Atlas of_cover = of_one_texel();
    of_cover.primitives = {2};
    const LightmapBake baked = bake_lightmap(scene, {whole(floors, 32), of_cover}, options);
    for (std::size_t p = 0; p < baked.lightmap.texels.size(); ++p) {
        const std::uint32_t texel = baked.lightmap.texels[p];
        if (texel < 32 * 32 && texel % 32 >= 17) { // beyond the texels that filters blend
            EXPECT_EQ(baked.lightmap.baked.transfer.vector(p)[0], 0) << texel;
        }
    }
}

TEST(LightmapBake, ReachesATargetError) {
    const Scene floor = floor_map(SceneBuilder().floor({0, 0, 0}, 1).build()),
                ball = test::join({floor, SceneBuilder().sphere({0.2f, 0.5f, 0}, 0.3f, 16).build()});
    const auto map = [&](const BakeOptions& options) {
        return bake_lightmap(floor, {whole(floor, 12)}, options, {&ball, 0.01});
    };
    BakeOptions options = options_of(3, 1 << 15, 0);
    options.repairs.denoise = false;
    const Transfer reference = map(options).lightmap.baked.transfer;
    for (const double target : {0.03, 0.005}) {
        options.target_error = target;
        const LightmapBake result = map(options);
        EXPECT_LE(result.statistics.sampling_error, target);
        EXPECT_LT(result.lightmap.baked.record.rays, 1 << 15);
        const double error = relative_l2(reference, result.lightmap.baked.transfer, result.lightmap.areas);
        EXPECT_LT(error, 1.25 * target);
        EXPECT_GT(error, 0.2 * target); // no rays thrown away
    }
}

TEST(LightmapBake, ReportsMisplacedHighPolyModels) {
    const Scene scene = floor_map(SceneBuilder().floor({0, 0, 0}, 1).build());
    const auto bake_with = [&](const Scene& finer) {
        return bake_lightmap(scene, {whole(scene, 8)}, options_of(2, 8, 0), {&finer, 0.1});
    };
    EXPECT_THROW(bake_with(SceneBuilder().floor({0, 0.2f, 0}, 1).build()), Error);
    const auto notices = [&](const Scene& finer) { return bake_with(finer).statistics.notices.size(); };
    EXPECT_GT(notices(SceneBuilder().floor({0.5f, 0.05f, 0}, 1.01f, 4).build()), // over three quarters
              notices(SceneBuilder().floor({0, 0.05f, 0}, 1.01f, 4).build()));
}

TEST(LightmapBake, RejectsMapsThatDoNotFitIntoMemory) {
    const Scene floor = floor_map(SceneBuilder().floor({0, 0, 0}, 1).build());
    BakeOptions options = options_of(10, 16, 0);
    options.memory.limit = 2000;
    try {
        bake_lightmap(floor, {whole(floor, 4)}, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("memory"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace prt

// Tests predictors from normals and positions: closed forms that clusters must find, and cases in which
// predictors are useless.

#include "prt/compress/compress.h"

#include "prt/compress/search.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/sh.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace {

struct Predicted {
    Transfer transfer;
    std::vector<float> areas;
    std::vector<glm::vec3> normals, positions;

    ReceiverSurface surface() const { return {areas, {}, normals, positions}; }
};

glm::vec3 random_direction(std::mt19937& random) {
    std::normal_distribution<float> normal;
    return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

/// Receivers anywhere with normals anywhere, and no transfer yet.
Predicted scattered(std::size_t receivers, int order, unsigned seed) {
    Predicted scene{zero_transfer(order, 1, receivers), std::vector<float>(receivers, 1.0f), {}, {}};
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (std::size_t p = 0; p < receivers; ++p) {
        scene.normals.push_back(random_direction(random));
        scene.positions.emplace_back(unit(random), 2 * unit(random), 0.5f * unit(random));
    }
    return scene;
}

/// Receivers on a sphere in the open: transfer is the clamped cosine of the normal (docs/math.md, eq. 6).
Predicted open_sphere(std::size_t receivers) {
    Predicted scene = scattered(receivers, 6, 3);
    for (std::size_t p = 0; p < receivers; ++p) {
        const Light lobe = directional_light(6, scene.normals[p], glm::vec3(1));
        const double factor[] = {1, 2.0 / 3, 0.25, 0, -1.0 / 24, 0};
        for (int l = 0; l < 6; ++l)
            for (int i = l * l; i < (l + 1) * (l + 1); ++i)
                scene.transfer.vector(p)[static_cast<std::size_t>(i)] = static_cast<float>(
                    factor[l] * static_cast<double>(lobe.coefficients[static_cast<std::size_t>(i)].x));
    }
    return scene;
}

double error_of(const Predicted& scene, const CompressResult& result) {
    return relative_l2(scene.transfer, decode(result.transfer), scene.areas);
}

CompressOptions with(PredictorChoice predictors, int clusters, const WeightCoding& coding) {
    CompressOptions options{.clusters = clusters, .coding = coding};
    options.predictors = predictors;
    options.metric = plain_metric(layout_of_one(coding.bits == 0 ? 4 : 6, 1));
    return options;
}

TEST(CompressPredictors, LinearTransferNeedsNoComponents) {
    Predicted scene = scattered(600, 4, 1);
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    std::vector<float> slopes(7 * 16);
    for (float& v : slopes)
        v = normal(random);
    for (std::size_t p = 0; p < 600; ++p) {
        const glm::vec3 n = scene.normals[p], x = scene.positions[p];
        const float predictors[] = {1, n.x, n.y, n.z, x.x, x.y, x.z};
        for (std::size_t i = 0; i < 16; ++i)
            for (std::size_t g = 0; g < 7; ++g)
                scene.transfer.vector(p)[i] += predictors[g] * slopes[g * 16 + i];
    }
    for (const WeightFormat format : {WeightFormat::float32, WeightFormat::packed}) {
        const auto error = [&](PredictorChoice predictors) {
            WeightCoding coding{.format = format, .components = 0, .bits = 0};
            CompressOptions options = with(predictors, 1, coding);
            options.basis_share = 0;
            return error_of(scene, compress(scene.transfer, scene.surface(), options));
        };
        EXPECT_LT(error(PredictorChoice::normal_and_position), 1e-5);
        EXPECT_GT(error(PredictorChoice::normal), 0.1);
        EXPECT_GT(error(PredictorChoice::none), 0.3);
    }
}

TEST(CompressPredictors, HalveTheErrorOfOpenReceivers) {
    const Predicted scene = open_sphere(4000);
    const auto error = [&](PredictorChoice predictors) {
        return error_of(scene, compress(scene.transfer, scene.surface(), with(predictors, 64, {.bits = 18})));
    };
    EXPECT_LT(error(PredictorChoice::normal), 0.5 * error(PredictorChoice::none));
}

TEST(CompressPredictors, CodesAreTheNearestOfTheirClusters) {
    // Each point's code in its cluster is as good as coding the residual of the predictors again, and the
    // reported error is that of the decoded transfer.
    const Predicted scene = open_sphere(700);
    const CompressResult result =
        compress(scene.transfer, scene.surface(), with(PredictorChoice::normal, 12, {.bits = 12}));
    const ClusteredTransfer& t = result.transfer;
    ASSERT_EQ(t.bases.predictors.size(), 1u);
    EXPECT_EQ(t.bases.predictors[0].kind, PredictorKind::normal);
    EXPECT_EQ(t.receivers.predictors.size(), 3 * 700u);
    EXPECT_EQ(result.statistics.predictor_rows, 3);
    EXPECT_NEAR(result.statistics.operations(), 3 + result.statistics.mean_components, 1e-12);
    EXPECT_NEAR(result.statistics.lit_rms, error_of(scene, result), 1e-4 * result.statistics.lit_rms);
}

TEST(CompressPredictors, DoNotDependOnThreads) {
    const Predicted scene = open_sphere(900);
    std::vector<ClusteredTransfer> results;
    for (const int threads : {1, 3}) {
        CompressOptions options = with(PredictorChoice::normal_and_position, 16, {});
        options.threads = threads;
        results.push_back(compress(scene.transfer, scene.surface(), options).transfer);
    }
    EXPECT_EQ(results[0].bases.rows, results[1].bases.rows);
    EXPECT_EQ(results[0].bases.centers, results[1].bases.centers);
    EXPECT_EQ(results[0].receivers.weights, results[1].receivers.weights);
}

TEST(CompressPredictors, UselessPredictorsAreHarmless) {
    Predicted scene = open_sphere(500);
    const double without =
        error_of(scene, compress(scene.transfer, scene.surface(), with(PredictorChoice::none, 16, {})));
    // Normals that are all equal, or all zero, predict nothing and are omitted.
    for (const glm::vec3 same : {glm::vec3(0, 1, 0), glm::vec3(0)}) {
        Predicted flat = scene;
        std::fill(flat.normals.begin(), flat.normals.end(), same);
        const CompressResult r =
            compress(flat.transfer, flat.surface(), with(PredictorChoice::normal, 16, {}));
        EXPECT_TRUE(r.transfer.bases.predictors.empty());
        EXPECT_EQ(error_of(flat, r), without);
    }
    // Random normals predict nothing, except in clusters with very few receivers.
    Predicted chance = scene;
    std::mt19937 random(8);
    for (glm::vec3& n : chance.normals)
        n = random_direction(random);
    const CompressResult r =
        compress(chance.transfer, chance.surface(), with(PredictorChoice::normal, 16, {}));
    EXPECT_LT(error_of(chance, r), 1.05 * without);
    // A renderer that has no normals.
    Predicted bare = scene;
    bare.normals.clear();
    const CompressResult plain =
        compress(bare.transfer, bare.surface(), with(PredictorChoice::normal, 16, {}));
    EXPECT_TRUE(plain.transfer.bases.predictors.empty());
    EXPECT_EQ(error_of(bare, plain), without);
}

TEST(CompressPredictors, PositionsFarFromTheMiddleLoseLittle) {
    Predicted scene = open_sphere(800);
    const auto error = [&](const Predicted& of) {
        return error_of(of, compress(of.transfer, of.surface(),
                                     with(PredictorChoice::normal_and_position, 16, {.bits = 18})));
    };
    Predicted far = scene;
    for (glm::vec3& x : far.positions)
        x += glm::vec3(100, -300, 50);
    EXPECT_NEAR(error(far), error(scene), 0.1 * error(scene));
}

/// Returns walls of nine receivers each, with almost equal normals, under random light.
Predicted walls(std::size_t count) {
    Predicted scene = scattered(9 * count, 4, 5);
    std::mt19937 random(6);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> digits(1, 3);
    for (std::size_t wall = 0; wall < count; ++wall) {
        const glm::vec3 facing = random_direction(random);
        const float deviation = std::pow(10.0f, -digits(random));
        for (std::size_t p = 9 * wall; p < 9 * (wall + 1); ++p) {
            scene.normals[p] = glm::normalize(facing + deviation * random_direction(random));
            for (std::size_t i = 0; i < 16; ++i)
                scene.transfer.vector(p)[i] = facing[static_cast<int>(i % 3)] +
                                              0.2f * normal(random) * std::pow(0.7f, static_cast<float>(i));
        }
    }
    return scene;
}

/// Normals of few receivers can produce slopes of any size, while all share one rounding step.
TEST(CompressPredictors, NearlyEqualNormalsDoNotHarmRounding) {
    const Predicted scene = walls(110);
    CompressOptions options = with(PredictorChoice::normal, 100, {.bits = 33});
    options.metric = plain_metric(scene.transfer.layout);
    options.basis_share = 0;
    const double exact = error_of(scene, compress(scene.transfer, scene.surface(), options));
    options.basis_share = 0.1;
    EXPECT_LT(error_of(scene, compress(scene.transfer, scene.surface(), options)), 1.2 * exact);
}

TEST(CompressPredictors, ShaderOperationsAreCountedWithThem) {
    const Predicted scene = open_sphere(500);
    for (const double most : {2.0, 5.0}) {
        SearchOptions options;
        options.compress.metric = plain_metric(scene.transfer.layout);
        options.budget.operations = most;
        const SearchResult found = compress_within(scene.transfer, scene.surface(), options);
        EXPECT_TRUE(found.kept);
        EXPECT_LE(found.result.statistics.operations(), most);
    }
}

TEST(CompressPredictors, WrongCountsAndNonFiniteValuesAreRejected) {
    Predicted scene = open_sphere(20);
    scene.normals.pop_back();
    EXPECT_THROW(compress(scene.transfer, scene.surface(), {}), Error);
    scene.normals.emplace_back(0, std::numeric_limits<float>::quiet_NaN(), 1);
    EXPECT_THROW(compress(scene.transfer, scene.surface(), {}), Error);
    scene.normals.back() = {0, 0, 1};
    scene.positions[3].x = std::numeric_limits<float>::infinity();
    EXPECT_THROW(compress(scene.transfer, scene.surface(), {}), Error);
}

} // namespace
} // namespace prt

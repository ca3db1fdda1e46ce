// Tests the search for a compression within a budget.

#include "prt/compress/search.h"

#include "compress/metric/error_moments.h"
#include "compress/metric/jumps.h"
#include "compress/metric/light_family.h"
#include "compress/metric/standard_skies.h"
#include "compress/study/baselines.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"

#include "prt/core/sh.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <numbers>
#include <numeric>
#include <random>
#include <tuple>

namespace prt {
namespace {

/// Something like transfer: smooth functions of two parameters with a crease, and a little noise.
Transfer smooth_transfer(std::size_t receivers, int channels, unsigned seed) {
    Transfer t = zero_transfer(4, channels, receivers);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<float> frequencies(3 * t.dimension());
    for (float& f : frequencies)
        f = 3 * uniform(random);
    for (std::size_t p = 0; p < receivers; ++p) {
        const float u = uniform(random), v = uniform(random);
        for (std::size_t i = 0; i < t.dimension(); ++i)
            t.vector(p)[i] =
                (i == 0 ? 1.0f : 0.3f) *
                    std::sin(frequencies[3 * i] * u + frequencies[3 * i + 1] * v + frequencies[3 * i + 2]) *
                    (u > 0.2f ? 1.0f : 0.4f) +
                0.002f * uniform(random);
    }
    return t;
}

/// Points of a spherical Fibonacci lattice.
std::vector<glm::vec3> lattice(int count) {
    std::vector<glm::vec3> points;
    for (int i = 0; i < count; ++i) {
        const float y = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(count);
        const float angle = 2.39996323f * static_cast<float>(i), radius = std::sqrt(1 - y * y);
        points.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
    }
    return points;
}

/// A prop of 232 receivers: four balls that shadow each other, by quadrature over the sphere.
Transfer prop_transfer() {
    constexpr int kOrder = 6, kDirections = 600;
    const glm::vec3 centers[4] = {{0, 0, 0}, {1.6f, 0.4f, 0}, {0.3f, 1.5f, 0.8f}, {-0.7f, 0.2f, -1.3f}};
    const float radii[4] = {1, 0.6f, 0.7f, 0.4f};
    const std::vector<glm::vec3> directions = lattice(kDirections), positions = lattice(58);
    Transfer t = zero_transfer(kOrder, 1, 4 * positions.size());
    std::vector<float> basis(static_cast<std::size_t>(coefficient_count(kOrder)));
    for (std::size_t p = 0; p < t.receivers(); ++p) {
        const std::size_t ball = p / positions.size();
        const glm::vec3 normal = positions[p % positions.size()],
                        position = centers[ball] + radii[ball] * normal;
        for (const glm::vec3& w : directions) {
            bool open = glm::dot(normal, w) > 0;
            for (std::size_t other = 0; other < 4; ++other) {
                const glm::vec3 to = centers[other] - position;
                const float along = glm::dot(to, w);
                open &= other == ball || along <= 0 ||
                        glm::dot(to, to) - along * along > radii[other] * radii[other];
            }
            if (!open)
                continue;
            evaluate_sh(kOrder, w, basis);
            for (std::size_t i = 0; i < basis.size(); ++i)
                t.vector(p)[i] += 4.0f / kDirections * glm::dot(normal, w) * basis[i];
        }
    }
    return t;
}

/// Returns the bytes per receiver, counted from the arrays, including the bases.
double bound_bytes(const CompressResult& result) {
    const ClusteredReceivers& r = result.transfer.receivers;
    return (static_cast<double>(r.weights.size()) + static_cast<double>(basis_bytes(result.transfer.bases))) /
           static_cast<double>(r.size());
}

struct Tried {
    Transfer transfer;
    std::vector<float> areas;

    explicit Tried(Transfer what) : transfer(std::move(what)), areas(transfer.receivers(), 1.0f) {}
    Tried(std::size_t receivers, int channels, unsigned seed)
        : Tried(smooth_transfer(receivers, channels, seed)) {}
    SearchResult within(const Budget& budget, WeightFormat format = WeightFormat::packed) const {
        SearchOptions options;
        options.budget = budget;
        options.compress.coding.format = format;
        return compress_within(transfer, {areas}, options);
    }
    double lit_rms(const CompressResult& result) const {
        return expected_lit_rms(transfer, decode(result.transfer), areas,
                                metric_of_family(LightFamily::outdoor, transfer.layout));
    }
};

TEST(Search, KeepsTheRequestedError) {
    const Tried scene(700, 1, 1);
    for (const double error : {0.1, 0.01}) {
        const SearchResult found = scene.within({error, {}, {}});
        EXPECT_TRUE(found.kept);
        EXPECT_LE(scene.lit_rms(found.result), error);
        EXPECT_GT(scene.lit_rms(found.result), 0.4 * error); // and spends no more than it needs
    }
}

/// Three random vectors, randomly mixed: one cluster with three components represents them, and more clusters
/// only reduce the bits of weights.
TEST(Search, FindsFewClustersForFewDimensions) {
    Transfer transfer = zero_transfer(5, 1, 500);
    std::mt19937 random(9);
    std::normal_distribution<float> normal;
    std::vector<float> rows(3 * transfer.dimension());
    for (float& v : rows)
        v = normal(random);
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        const float weights[] = {normal(random), normal(random), normal(random)};
        for (std::size_t i = 0; i < rows.size(); ++i)
            transfer.vector(p)[i % transfer.dimension()] += weights[i / transfer.dimension()] * rows[i];
    }
    const Tried scene(std::move(transfer));
    const SearchResult found = scene.within({.bytes_per_vertex = 8});
    ASSERT_TRUE(found.kept);
    CompressOptions by_hand{
        .clusters = 1, .coding = {.components = 3, .bits = 32}, .predictors = PredictorChoice::none};
    EXPECT_LE(found.result.statistics.lit_rms,
              1.05 * compress(scene.transfer, {scene.areas}, by_hand).statistics.lit_rms);
}

/// Transfer of one vector with both signs is dark at some rotation of every sky, and any error relative to
/// the light is infinite there.
TEST(Search, KeepsAnErrorLimitIfLightVanishesAtSomeRotation) {
    Transfer signs = zero_transfer(4, 1, 300), constant = signs;
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    for (std::size_t p = 0; p < signs.receivers(); ++p)
        for (std::size_t i = 0; i < signs.dimension(); ++i) {
            const float direction = std::sin(3.0f * static_cast<float>(i) + 1);
            signs.vector(p)[i] = (p % 3 == 0 ? -1.0f : 1.0f) * direction;
            constant.vector(p)[i] = direction + 1e-7f * normal(random);
        }
    Budget budget{.max_error = 0.01};
    for (const Lighting& day : members_of_family(LightFamily::outdoor, 4))
        budget.skies.push_back({day.suns ? sum(day.sky, *day.suns) : day.sky});
    for (Transfer& transfer : {std::ref(signs), std::ref(constant)}) {
        const SearchResult found = Tried(std::move(transfer)).within(budget);
        EXPECT_TRUE(found.kept);
        EXPECT_LE(found.best.worst_lit_rms, 0.01);
    }
}

TEST(Search, KeepsTheErrorAtEveryRotationOfGivenSkies) {
    const Tried scene(700, 1, 1);
    const std::vector<Lighting> days = members_of_family(LightFamily::outdoor, 4);
    Budget budget{.max_error = 0.02};
    for (const Lighting& day : {days.front(), days.back()})
        budget.skies.push_back({day.suns ? sum(day.sky, *day.suns) : day.sky});
    const SearchResult found = scene.within(budget);
    EXPECT_TRUE(found.kept);
    const Transfer decoded = decode(found.result.transfer);
    double worst = 0;
    for (const Lighting& sky : budget.skies)
        for (int rotation = 0; rotation < 72; ++rotation) {
            const Light light = rotated_about_y(sky.sky, rotation * std::numbers::pi / 36);
            worst = std::max(worst, lit_rms(exit_radiance(scene.transfer, light),
                                            exit_radiance(decoded, light), scene.areas));
        }
    EXPECT_LE(worst, 0.02);
    EXPECT_GT(worst, 0.01);
}

/// A promise under the members of a family holds for days between them, and with texture of the
/// family's power (clouds, trees) up to a twentieth.
TEST(Search, KeepsTheErrorUnderSkiesDrawnFromTheFamily) {
    const Tried scene(500, 1, 2);
    Budget budget{.max_error = 0.02};
    for (const Lighting& day : members_of_family(LightFamily::outdoor, 4))
        budget.skies.push_back({day.suns ? sum(day.sky, *day.suns) : day.sky});
    const Transfer decoded = decode(scene.within(budget).result.transfer);
    const ErrorMoments moments = error_moments(scene.transfer, decoded, scene.areas);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> elevation(0.105, 1.48), turbidity(2.5, 6);
    std::normal_distribution<double> normal;
    const std::vector<double> texture = family_model(LightFamily::outdoor, 4).texture;
    for (int draw = 0; draw < 20; ++draw) {
        const Lighting day =
            daylight(4, {.sun_elevation = elevation(random), .turbidity = turbidity(random)});
        Light light = sum(day.sky, *day.suns);
        EXPECT_LE(lit_rms_over_rotations(moments, {light}).worst, 0.02);
        for (int i = 1; i < 16; ++i) {
            const auto band = static_cast<std::size_t>(std::sqrt(i));
            const double power = texture[band] * std::pow(static_cast<double>(day.sky.coefficients[0].x), 2);
            light.coefficients[static_cast<std::size_t>(i)] +=
                glm::vec3(static_cast<float>(std::sqrt(power) * normal(random)));
        }
        EXPECT_LE(lit_rms_over_rotations(moments, {light}).worst, 1.05 * 0.02);
    }
}

TEST(Search, OrdersLimitsByRemainingSlack) {
    const Budget budget{.max_error = 0.1, .operations = 8.0, .max_jump = 0.05};
    const SearchTrial trial{.lit_rms = 0.03,
                            .worst_lit_rms = 0.04,
                            .sky_contrast = 0.05,
                            .lamp_contrast = 0.09,
                            .jump = 0.049,
                            .bytes_per_vertex = 99,
                            .operations = 2};
    std::vector<Promise> order;
    for (const PromiseKept& kept : promises_of(budget, trial))
        order.push_back(kept.promise);
    EXPECT_EQ(order, (std::vector{Promise::jump, Promise::lamps, Promise::skies, Promise::error,
                                  Promise::operations}));
    EXPECT_DOUBLE_EQ(promises_of(budget, trial)[0].share(), 0.98);
}

/// Neighbours in a row along one parameter of the transfer.
TEST(Search, LimitsJumpsAcrossClusters) {
    Transfer transfer = zero_transfer(3, 1, 700);
    std::vector<Edge> edges;
    for (std::uint32_t p = 0; p < 700; ++p) {
        for (std::uint32_t i = 0; i < 9; ++i)
            transfer.vector(p)[i] = 1 + std::sin(0.01f * static_cast<float>((i + 1) * p));
        if (p > 0)
            edges.push_back({p - 1, p});
    }
    const std::vector<float> areas(700, 1.0f);
    const ReceiverSurface surface{areas, edges, {}, {}};
    SearchOptions options;
    options.compress.metric = plain_metric(transfer.layout);
    const auto jump = [&] {
        const SearchResult found = compress_within(transfer, surface, options);
        EXPECT_TRUE(found.kept);
        return ClusterJumps(transfer, surface, *options.compress.metric)
            .percentile_99(decode(found.result.transfer), found.result.transfer.receivers.cluster_indices());
    };
    options.budget.max_error = 0.05;
    const double free = jump();
    EXPECT_GT(free, 0.01);
    options.budget.max_jump = 0.5 * free;
    EXPECT_LE(jump(), 0.5 * free);
    // The limit also holds under each of two skies at every rotation.
    for (const double elevation : {0.3, 1.0})
        options.budget.skies_of_jumps.push_back({*daylight(3, {.sun_elevation = elevation}).suns});
    const SearchResult found = compress_within(transfer, surface, options);
    EXPECT_TRUE(found.kept);
    const Transfer decoded = decode(found.result.transfer);
    for (const Lighting& sky : options.budget.skies_of_jumps)
        for (int rotation = 0; rotation < 24; ++rotation) {
            const Light light = rotated_about_y(sky.sky, rotation * std::numbers::pi / 12);
            const auto wanted = exit_radiance(transfer, light), given = exit_radiance(decoded, light);
            double logarithms = 0, largest = 0; // receivers of equal area
            for (const glm::vec3& radiance : wanted)
                largest = std::max(largest, static_cast<double>(radiance.x));
            double lit = 0;
            for (const glm::vec3& radiance : wanted)
                if (const auto y = static_cast<double>(std::abs(radiance.x)); y > 0) {
                    logarithms += std::log(std::max(y, 1e-6 * largest));
                    ++lit;
                }
            const double adaptation = 0.1 * std::exp(logarithms / lit);
            const auto contrast = [&](std::uint32_t p) {
                return static_cast<double>(given[p].x - wanted[p].x) /
                       (static_cast<double>(std::abs(wanted[p].x)) + adaptation);
            };
            std::vector<double> jumps;
            for (const Edge& edge : edges)
                if (found.result.transfer.receivers.cluster(edge.first) !=
                    found.result.transfer.receivers.cluster(edge.second))
                    jumps.push_back(std::abs(contrast(edge.first) - contrast(edge.second)));
            std::ranges::sort(jumps, std::greater());
            EXPECT_LE(jumps.empty() ? 0 : jumps[jumps.size() / 100], 0.5001 * free);
        }
    options.budget.skies_of_jumps.clear();
    options.budget.max_error.reset(); // one cluster jumps nowhere
    EXPECT_THROW(compress_within(transfer, surface, options), Error);
}

TEST(Search, RejectsPredictorsBeyondTheOperationLimit) {
    const Tried scene(100, 1, 1);
    const std::vector<glm::vec3> normals = lattice(100);
    SearchOptions options;
    options.choose_predictors = false;
    options.budget.operations = 2;
    EXPECT_THROW(compress_within(scene.transfer, {.areas = scene.areas, .normals = normals}, options), Error);
    options.budget.operations = 3; // all of them used by predictors
    const SearchResult found =
        compress_within(scene.transfer, {.areas = scene.areas, .normals = normals}, options);
    EXPECT_EQ(found.result.statistics.operations(), 3);
}

TEST(Search, KeepsTheRequestedBytes) {
    const Tried scene(700, 3, 2);
    for (const double bytes : {7.0, 12.5}) {
        const SearchResult found = scene.within({{}, bytes, {}});
        EXPECT_TRUE(found.kept);
        EXPECT_LE(bound_bytes(found.result), bytes);
        EXPECT_DOUBLE_EQ(bound_bytes(found.result), found.result.statistics.bytes_with_bases(700));
        EXPECT_GT(found.result.statistics.bytes_with_bases(700), 0.85 * bytes);
    }
}

TEST(Search, KeepsTheRequestedOperations) {
    const Tried scene(600, 1, 3);
    for (const double ops : {0.5, 3.0}) {
        const SearchResult found = scene.within({{}, {}, ops});
        EXPECT_TRUE(found.kept);
        EXPECT_LE(found.result.statistics.operations(), ops);
        EXPECT_GT(found.result.statistics.operations(), 0.6 * ops);
    }
}

TEST(Search, KeepsThreeLimitsOrReportsFailure) {
    const Tried scene(600, 1, 4);
    const SearchResult loose = scene.within({0.05, 12.0, 8.0});
    EXPECT_TRUE(loose.kept);
    EXPECT_LE(loose.result.statistics.lit_rms, 0.05);
    EXPECT_LE(loose.result.statistics.bytes_with_bases(600), 12);
    EXPECT_LE(loose.result.statistics.operations(), 8);
    const SearchResult tight = scene.within({1e-4, 1.5, {}});
    EXPECT_FALSE(tight.kept);
    EXPECT_GT(tight.result.transfer.receivers.size(), 0u); // the nearest there is
}

TEST(Search, FloatWeightsKeepLimits) {
    const Tried scene(500, 1, 5);
    const SearchResult found = scene.within({0.03, {}, {}}, WeightFormat::float32);
    EXPECT_TRUE(found.kept);
    EXPECT_EQ(found.result.transfer.receivers.format, WeightFormat::float32);
    EXPECT_LE(scene.lit_rms(found.result), 0.03);
}

TEST(Search, IsMonotoneInEveryBudget) {
    const Tried scene(600, 1, 6);
    double before = 1e9;
    for (const double bytes : {5.0, 8.0, 12.0}) {
        const double error = scene.within({{}, bytes, {}}).result.statistics.lit_rms;
        EXPECT_LT(error, before);
        before = error;
    }
    before = 0;
    for (const double error : {0.1, 0.01}) {
        const double bytes = scene.within({error, {}, {}}).result.statistics.bytes_with_bases(600);
        EXPECT_GT(bytes, before);
        before = bytes;
    }
    before = 1e9;
    for (const double ops : {1.0, 4.0}) {
        const double error = scene.within({{}, {}, ops}).result.statistics.lit_rms;
        EXPECT_LT(error, before);
        before = error;
    }
}

TEST(Search, IsNeverWorseThanRelatedMethodsAtEqualSize) {
    for (const unsigned seed : {11u, 13u}) {
        const int channels = seed == 13 ? 3 : 1;
        const Tried scene(600, channels, seed);
        const LightMetric metric = metric_of_family(LightFamily::outdoor, layout_of_one(4, channels));
        for (const auto& [clusters, components] : {std::pair(1, 6), std::pair(64, 0), std::pair(16, 2)}) {
            const BaselineResult other =
                classic_cpca(scene.transfer, scene.areas, {.clusters = clusters, .components = components});
            const double bytes = other.payload_bytes + other.table_bytes / 600; // both bind whole words
            const double error = expected_lit_rms(scene.transfer, other.decoded, scene.areas, metric);
            const SearchResult ours = scene.within({{}, bytes, {}});
            EXPECT_TRUE(ours.kept);
            EXPECT_LT(ours.result.statistics.lit_rms, error) << clusters << " x " << components;
        }
    }
}

TEST(Search, MatchesAGridSearchOnSmallMeshes) {
    const Tried prop(prop_transfer());
    struct Cell {
        double bytes, error;
    };
    std::vector<Cell> grid;
    for (const int clusters : {1, 2, 4, 8, 16, 32})
        for (const int bits : {12, 26, 56}) {
            CompressOptions o;
            o.clusters = clusters;
            o.coding.bits = bits;
            const CompressResult r = compress(prop.transfer, {prop.areas}, o);
            grid.push_back({bound_bytes(r), r.statistics.lit_rms});
        }
    for (const double bytes : {12.0, 24.0}) {
        double best = 1;
        for (const Cell& cell : grid)
            best = cell.bytes <= bytes ? std::min(best, cell.error) : best;
        const SearchResult found = prop.within({{}, bytes, {}});
        EXPECT_LE(bound_bytes(found.result), bytes);
        EXPECT_LT(found.result.statistics.lit_rms, 1.05 * best) << bytes << " bytes";
    }
    for (const double error : {0.03, 0.003}) {
        double best = 1e9;
        for (const Cell& cell : grid)
            best = cell.error <= error ? std::min(best, cell.bytes) : best;
        const SearchResult found = prop.within({error, {}, {}});
        EXPECT_LE(found.result.statistics.lit_rms, error);
        EXPECT_LT(bound_bytes(found.result), 1.05 * best) << error;
    }
}

TEST(Search, OperationBudgetMatchesManualSettings) {
    const Tried scene(2500, 1, 7);
    const SearchResult alone = scene.within({{}, {}, 2.0});
    EXPECT_LE(alone.result.statistics.operations(), 2);
    EXPECT_LT(bound_bytes(alone.result), 24.01); // at most three times two words
    CompressOptions by_hand;
    by_hand.clusters = 208; // a dozen receivers each
    by_hand.coding.components = 2;
    by_hand.coding.bits = 22;
    const CompressResult hand = compress(scene.transfer, {scene.areas}, by_hand);
    EXPECT_LT(alone.result.statistics.lit_rms, 1.05 * hand.statistics.lit_rms);
}

TEST(Presets, FillTheirWords) {
    for (const auto& [preset, bits, components] :
         {std::tuple(preset_u32x4(), 32, 4), std::tuple(preset_u64x9(), 64, 9)}) {
        EXPECT_EQ(preset.components, components);
        EXPECT_EQ(preset.fixed_bits.size(), static_cast<std::size_t>(components));
        EXPECT_EQ(std::accumulate(preset.fixed_bits.begin(), preset.fixed_bits.end(), preset.cluster_bits),
                  bits);
    }
    EXPECT_EQ(preset_u32().bits + preset_u32().cluster_bits, 32);
    EXPECT_EQ(preset_u64().bits + preset_u64().cluster_bits, 64);
}

/// Half of the receivers are equal, so that clusters need no directions there.
TEST(Presets, FixedBitsHaveOneLayoutForAllClusters) {
    Transfer transfer = smooth_transfer(600, 1, 4);
    for (std::size_t p = 0; p < 300; ++p)
        std::ranges::copy(transfer.vector(0), transfer.vector(p).begin());
    const std::vector<float> areas(600, 1.0f);
    CompressOptions options{.clusters = 16, .coding = preset_u32x4()};
    const CompressResult result = compress(transfer, {areas}, options);
    EXPECT_TRUE(clusters_have_equal_layout(result.transfer.bases));
    EXPECT_EQ(result.statistics.mean_components, 4);
    options.coding = preset_u32();
    EXPECT_FALSE(clusters_have_equal_layout(compress(transfer, {areas}, options).transfer.bases));
    EXPECT_LT(relative_l2(transfer, decode(result.transfer), areas), 0.1);
}

TEST(Search, PresetsFitSmallMeshes) {
    const Tried prop(prop_transfer());
    for (const auto& [preset, words] : {std::pair(preset_u32(), 1), std::pair(preset_u64(), 2)}) {
        const SearchResult found = compress_preset(prop.transfer, {prop.areas}, {.coding = preset});
        EXPECT_TRUE(found.kept);
        EXPECT_EQ(found.result.transfer.receivers.words, words);
        EXPECT_LE(basis_bytes(found.result.transfer.bases), 4096u);
        EXPECT_LT(found.result.statistics.lit_rms, 0.03);
        EXPECT_GT(found.result.statistics.operations(), 1); // clusters, not a copy of the mesh
    }
    // If the bases fit, the preset is used unchanged.
    const Tried large(3000, 1, 8);
    const SearchResult whole = compress_preset(large.transfer, {large.areas}, {.coding = preset_u32()});
    EXPECT_TRUE(whole.trials.empty());
    EXPECT_EQ(whole.result.transfer.receivers.cluster_bits, 8);
}

TEST(Search, KeepsBudgetsThatNeedFewerDirections) {
    const Tried prop(prop_transfer()), ten(10, 3, 9);
    for (const Tried* scene : {&prop, &ten})
        for (const int components : {0, 1, 3}) {
            CompressOptions by_hand;
            by_hand.clusters = 1;
            by_hand.coding.components = components;
            const CompressResult hand = compress(scene->transfer, {scene->areas}, by_hand);
            const double bytes = 1.02 * bound_bytes(hand);
            const SearchResult found = scene->within({{}, bytes, {}});
            EXPECT_TRUE(found.kept) << components;
            EXPECT_LE(bound_bytes(found.result), bytes);
            // By hand 24 bits of a word are used, and coarser bases go with them.
            EXPECT_LE(found.result.statistics.lit_rms, 1.35 * hand.statistics.lit_rms) << components;
        }
}

TEST(Search, FloatWeightsFitSmallMeshes) {
    const Tried prop(prop_transfer());
    CompressOptions floats;
    floats.coding.format = WeightFormat::float32;
    floats.coding.components = 8;
    const SearchResult found = compress_preset(prop.transfer, {prop.areas}, floats);
    EXPECT_TRUE(found.kept);
    EXPECT_LE(basis_bytes(found.result.transfer.bases), 36u * 2 * 232); // twice cluster and weights
    EXPECT_GT(found.result.statistics.operations(), 1);
    EXPECT_LT(found.result.statistics.lit_rms, 0.03);
}

TEST(Search, ReportsTheTimeOfAllTrials) {
    const SearchResult found = Tried(300, 1, 10).within({{}, 12.0, {}});
    double seconds = 0;
    for (const SearchTrial& trial : found.trials)
        seconds += trial.seconds;
    EXPECT_GT(found.trials.size(), 1u);
    EXPECT_GE(found.result.statistics.seconds, seconds);
}

TEST(Search, RejectsInvalidBudgets) {
    const Tried scene(50, 1, 1);
    EXPECT_THROW(scene.within({}), Error);
    EXPECT_THROW(scene.within({0.0, {}, {}}), Error);
    EXPECT_THROW(scene.within({{}, -1.0, {}}), Error);
    EXPECT_THROW(scene.within({{}, {}, std::nan("")}), Error);
}

} // namespace
} // namespace prt

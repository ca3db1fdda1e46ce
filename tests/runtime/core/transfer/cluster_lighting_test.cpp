// Tests the constants of clusters under a light.

#include "prt/core/cluster_lighting.h"

#include "prt/core/error.h"
#include "support/predicted.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <random>
#include <utility>

namespace prt {
namespace {

ClusteredTransfer random_transfer(const TransferLayout& layout, WeightFormat format) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    ClusteredTransfer t;
    t.bases.layout = layout;
    t.bases.components = {3, 0, 7, 1, 9, 4};
    t.receivers.format = format;
    std::size_t rows = 0;
    for (const int m : t.bases.components) {
        rows += 1 + static_cast<std::size_t>(m);
        for (int j = 0; format == WeightFormat::packed && j < m; ++j)
            t.bases.bits.push_back(static_cast<std::uint8_t>(3 + j));
    }
    for (std::size_t i = 0; i < rows * t.bases.dimension(); ++i)
        t.bases.rows.push_back(normal(random));
    return t;
}

ClusteredTransfer random_transfer(int order, int channels, WeightFormat format) {
    return random_transfer(layout_of_one(order, channels), format);
}

Light random_light(int order) {
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    Light light{order, {}};
    for (int i = 0; i < coefficient_count(order); ++i)
        light.coefficients.emplace_back(normal(random), normal(random), normal(random));
    return light;
}

struct Kind {
    int order, channels;
    WeightFormat format;
};
class Constants : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Constants,
                         testing::Values(Kind{1, 1, WeightFormat::float32}, Kind{6, 1, WeightFormat::float32},
                                         Kind{6, 3, WeightFormat::float32}, Kind{6, 3, WeightFormat::packed},
                                         Kind{10, 3, WeightFormat::packed}));

TEST_P(Constants, AreDotProductsOfRowsAndLight) {
    const auto [order, channels, format] = GetParam();
    const ClusteredTransfer t = random_transfer(order, channels, format);
    const Light light = random_light(order);
    const ClusterLighting relighter(t);
    ASSERT_EQ(relighter.rows(), constant_rows(t.bases));
    std::vector<glm::vec4> constants(relighter.rows());
    relighter.update(light.coefficients, constants);
    std::size_t row = 0, bit = 0;
    const auto product = [&](std::size_t r) {
        return exit_radiance({&t.bases.rows[r * t.bases.dimension()], t.bases.dimension()}, t.bases.layout,
                             light.coefficients);
    };
    for (const int m : t.bases.components) {
        glm::vec3 mean = product(row);
        const std::size_t first = row++;
        for (int j = 0; j < m; ++j, ++row) {
            glm::vec3 expected = product(row);
            if (format ==
                WeightFormat::packed) { // the shader multiplies the integer q: w = 2 q / largest - 1
                mean -= expected;
                expected *= 2 / static_cast<float>((1u << t.bases.bits[bit++]) - 1);
            }
            EXPECT_LT(glm::distance(glm::vec3(constants[row]), expected), 2e-5f);
        }
        EXPECT_LT(glm::distance(glm::vec3(constants[first]), mean), 2e-4f); // ten sums of 300 products
        EXPECT_EQ(constants[first].w, 0);
    }
}

TEST_P(Constants, IncludeScalesAndCentersOfPredictors) {
    const auto [order, channels, format] = GetParam();
    ClusteredTransfer t = random_transfer(order, channels, format);
    const ClusteredTransfer plain = t;
    std::mt19937 random(9);
    test::add_predictors(t.bases, {PredictorKind::normal, PredictorKind::position}, random);
    const Light light = random_light(order);
    const ClusterLighting relighter(t), without(plain);
    std::vector<glm::vec4> constants(relighter.rows()), of_plain(without.rows());
    relighter.update(light.coefficients, constants);
    without.update(light.coefficients, of_plain);
    const std::vector<std::size_t> first = t.bases.first_rows(), first_plain = plain.bases.first_rows();
    for (std::size_t k = 0; k < t.bases.clusters(); ++k) {
        glm::vec3 mean(of_plain[first_plain[k]]);
        for (std::size_t g = 0; g < 6; ++g) {
            const std::size_t r = first[k] + 1 + g;
            const glm::vec3 row = exit_radiance({&t.bases.rows[r * t.bases.dimension()], t.bases.dimension()},
                                                t.bases.layout, light.coefficients);
            EXPECT_LT(glm::distance(glm::vec3(constants[r]), t.bases.predictor_scale(g) * row), 5e-5f);
            mean -= static_cast<float>(t.bases.centers[6 * k + g]) * row;
        }
        EXPECT_LT(glm::distance(glm::vec3(constants[first[k]]), mean), 2e-4f);
        for (std::size_t j = 0; j < static_cast<std::size_t>(t.bases.components[k]); ++j)
            EXPECT_EQ(constants[first[k] + 7 + j], of_plain[first_plain[k] + 1 + j]);
    }
}

/// By hand, from the rows of each part and the light on it.
TEST(ConstantsOfTerms, AreTheSumOfEachUnderItsLight) {
    for (const auto& [direct, indirect] :
         {std::pair(1, 1), std::pair(1, 3), std::pair(3, 1), std::pair(3, 3)}) {
        const TransferLayout layout{5, {{TermKind::direct, direct}, {TermKind::indirect, indirect}}};
        const ClusteredTransfer t = random_transfer(layout, WeightFormat::float32);
        const Light sky = random_light(6), suns = directional_light(5, {0, 1, 0}, {3, 2, 1});
        const ClusterLighting relighter(t);
        std::vector<glm::vec4> constants(relighter.rows());
        relighter.update(Lighting{sky, suns}, constants);
        for (std::size_t row = 0; row < relighter.rows(); ++row) {
            const float* of = &t.bases.rows[row * t.bases.dimension()];
            glm::dvec3 expected(0);
            for (int c = 0; c < 3; ++c)
                for (std::size_t i = 0; i < 25; ++i) {
                    const double lit_directly = static_cast<double>(sky.coefficients[i][c]),
                                 lit_after = lit_directly + static_cast<double>(suns.coefficients[i][c]);
                    const std::size_t of_direct = direct == 3 ? 25 * static_cast<std::size_t>(c) : 0,
                                      of_rest = indirect == 3 ? 25 * static_cast<std::size_t>(c) : 0;
                    expected[c] += lit_directly * static_cast<double>(of[of_direct + i]) +
                                   lit_after * static_cast<double>(
                                                   of[25 * static_cast<std::size_t>(direct) + of_rest + i]);
                }
            EXPECT_LT(glm::distance(glm::dvec3(constants[row]), expected), 1e-4) << row;
        }
    }
}

/// Compares with `exit_radiance` of the rows.
TEST(ConstantsOfTerms, IncludeLampsWithAndWithoutSky) {
    for (const bool has_sky : {true, false}) {
        TransferLayout layout{4, {}};
        if (has_sky)
            layout.terms = {{TermKind::combined, 3}};
        layout.terms.push_back({TermKind::lamp, 1, "white"});
        layout.terms.push_back({TermKind::lamp, 3, "red"});
        const ClusteredTransfer t = random_transfer(layout, WeightFormat::float32);
        Lighting lighting{random_light(4)};
        lighting.lamps = {{1, 2, 3}, {0, 5, 1}};
        const ClusterLighting relighter(t);
        std::vector<glm::vec4> constants(relighter.rows());
        relighter.update(lighting, constants);
        const std::vector<glm::vec3> columns = light_columns(layout, lighting);
        for (std::size_t row = 0; row < relighter.rows(); ++row) {
            const std::span<const float> of(&t.bases.rows[row * t.bases.dimension()], t.bases.dimension());
            EXPECT_LT(glm::distance(glm::vec3(constants[row]), exit_radiance(of, layout, columns)), 1e-4f);
        }
    }
}

TEST_P(Constants, DoNotDependOnRanges) {
    const auto [order, channels, format] = GetParam();
    const ClusterLighting relighter(random_transfer(order, channels, format));
    const Light light = random_light(order);
    std::vector<glm::vec4> whole(relighter.rows()), terms(relighter.rows(), glm::vec4(-7));
    relighter.update(light.coefficients, whole);
    relighter.update(light.coefficients, terms, 0, 16);
    for (std::size_t row = 16; row < relighter.rows(); ++row) // a second thread may write there
        EXPECT_EQ(terms[row], glm::vec4(-7));
    relighter.update(light.coefficients, terms, 16, relighter.rows());
    EXPECT_EQ(whole, terms);
}

TEST(Constants, BlendLikeTheLights) {
    const ClusteredTransfer t = random_transfer(4, 1, WeightFormat::float32);
    const ClusterLighting relighter(t);
    const Light a = random_light(4), b = constant_light(4, {1, 2, 3});
    std::vector<glm::vec4> of_a(relighter.rows()), of_b(relighter.rows()), of_blend(relighter.rows()),
        blend(relighter.rows());
    relighter.update(a.coefficients, of_a);
    relighter.update(b.coefficients, of_b);
    relighter.update(blended(a, b, 0.3f).coefficients, of_blend);
    blend_constants(of_a, of_b, 0.3f, blend);
    for (std::size_t i = 0; i < blend.size(); ++i)
        EXPECT_LT(glm::distance(blend[i], of_blend[i]), 1e-4f);
}

TEST(Constants, LightOfFewerBandsIsRejected) {
    const ClusterLighting relighter(random_transfer(4, 1, WeightFormat::float32));
    std::vector<glm::vec4> constants(relighter.rows());
    EXPECT_THROW(relighter.update(constant_light(3, {1, 1, 1}).coefficients, constants), Error);
    EXPECT_NO_THROW(
        relighter.update(constant_light(5, {1, 1, 1}).coefficients, constants)); // more do no harm
}

} // namespace
} // namespace prt

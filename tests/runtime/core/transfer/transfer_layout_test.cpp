// Tests layouts of transfer terms.

#include "prt/core/transfer_layout.h"

#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/transfer.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prt {
namespace {

TransferLayout direct_and_indirect(int order, int direct, int indirect) {
    return {order, {{TermKind::direct, direct}, {TermKind::indirect, indirect}}};
}

Light light_of(int order, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    Light light{order, {}};
    for (int i = 0; i < order * order; ++i)
        light.coefficients.emplace_back(normal(random), normal(random), normal(random));
    return light;
}

Transfer transfer_of(const TransferLayout& layout, std::size_t receivers, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    Transfer transfer = zero_transfer(layout, receivers);
    for (float& v : transfer.vectors)
        v = normal(random);
    return transfer;
}

TEST(TransferLayout, CountsTheColumnsOfItsTerms) {
    const TransferLayout layout = direct_and_indirect(4, 1, 3);
    EXPECT_EQ(layout.channels(), 3);
    EXPECT_EQ(layout.dimension(), 64u);
    EXPECT_EQ(layout.columns(), 32u);
    EXPECT_TRUE(layout.has(TermKind::direct));
    EXPECT_FALSE(layout.has(TermKind::combined));
    EXPECT_EQ(layout_of_one(3, 1).dimension(), 9u);
}

TEST(TransferLayout, InvalidLayoutsAreRejected) {
    EXPECT_NO_THROW(check_layout(direct_and_indirect(10, 3, 3)));
    EXPECT_NO_THROW(check_layout(layout_of_one(1, 1, TermKind::indirect)));
    for (const TransferLayout& layout :
         {TransferLayout{4, {}}, direct_and_indirect(0, 1, 1), direct_and_indirect(11, 1, 1),
          direct_and_indirect(4, 2, 1), direct_and_indirect(4, 1, 0),
          TransferLayout{4, {{TermKind::indirect, 1}, {TermKind::direct, 1}}},
          TransferLayout{4, {{TermKind::direct, 1}, {TermKind::direct, 1}}},
          TransferLayout{4, {{TermKind::direct, 1}, {TermKind::combined, 1}}}})
        EXPECT_THROW(check_layout(layout), Error);
}

/// A sky in two parts, a white lamp and a coloured one.
TransferLayout with_two_lamps(int order) {
    TransferLayout layout = direct_and_indirect(order, 1, 3);
    layout.terms.push_back({TermKind::lamp, 1, "white"});
    layout.terms.push_back({TermKind::lamp, 3, "red"});
    return layout;
}

TEST(TransferLayout, LampsHaveOneNumberPerChannel) {
    const TransferLayout layout = with_two_lamps(4), lamps{4, {layout.terms.end() - 2, layout.terms.end()}};
    EXPECT_NO_THROW(check_layout(layout));
    EXPECT_NO_THROW(check_layout(lamps)); // no sky light enters
    EXPECT_EQ(layout.lamps(), 2u);
    EXPECT_EQ(layout.dimension(), 68u);
    EXPECT_EQ(layout.columns(), 34u);
    EXPECT_EQ(lamps.dimension(), 4u);
    EXPECT_EQ(lamps.columns(), 2u);
    TransferLayout wrong = layout;
    wrong.terms[3].name = "white";
    EXPECT_THROW(check_layout(wrong), Error); // which of them?
    wrong.terms[3].name = "";
    EXPECT_THROW(check_layout(wrong), Error);
    wrong = layout;
    wrong.terms[0].name = "sun";
    EXPECT_THROW(check_layout(wrong), Error);
    wrong = layout;
    std::swap(wrong.terms[1], wrong.terms[2]);
    EXPECT_THROW(check_layout(wrong), Error); // lamps must be last
    wrong = {4, {}};
    for (std::size_t k = 0; k <= kMaxLamps; ++k)
        wrong.terms.push_back({TermKind::lamp, 1, std::to_string(k)});
    EXPECT_THROW(check_layout(wrong), Error);
    wrong.terms.pop_back();
    EXPECT_NO_THROW(check_layout(wrong));
}

TEST(LightColumns, LampColumnsAreTheirStrengths) {
    const TransferLayout layout = with_two_lamps(3);
    Lighting lighting{light_of(3, 1)};
    std::vector<glm::vec3> columns = light_columns(layout, lighting);
    ASSERT_EQ(columns.size(), 20u);
    EXPECT_EQ(columns[17], lighting.sky.coefficients[8]);
    EXPECT_EQ(columns[18], glm::vec3(1)); // strength of the scene
    EXPECT_EQ(columns[19], glm::vec3(1));
    lighting.lamps = {{1, 2, 3}, {4, 5, 6}};
    columns = light_columns(layout, lighting);
    EXPECT_EQ(columns[18], glm::vec3(1, 2, 3));
    EXPECT_EQ(columns[19], glm::vec3(4, 5, 6));
    lighting.lamps.pop_back();
    EXPECT_THROW(light_columns(layout, lighting), Error);
}

TEST(ExitRadiance, ScalesWithLampStrength) {
    Transfer transfer = transfer_of(with_two_lamps(2), 3, 8);
    Lighting lighting{light_of(2, 1)};
    lighting.lamps = {{1, 2, 3}, {4, 5, 6}};
    const auto lit = exit_radiance(transfer, lighting);
    lighting.lamps.assign(2, glm::vec3(0));
    const auto by_sky = exit_radiance(transfer, lighting);
    for (std::size_t p = 0; p < 3; ++p) {
        const auto t = transfer.vector(p);
        const glm::vec3 lamps =
            t[16] * glm::vec3(1, 2, 3) + glm::vec3(t[17], t[18], t[19]) * glm::vec3(4, 5, 6);
        EXPECT_LT(glm::distance(lit[p], by_sky[p] + lamps), 1e-5f);
    }
}

TEST(CombinedTransfer, KeepsLamps) {
    const Transfer terms = transfer_of(with_two_lamps(3), 20, 9), whole = as_combined(terms);
    EXPECT_EQ(whole.layout.terms.size(), 3u);
    EXPECT_EQ(whole.layout.terms[0], (TransferTerm{TermKind::combined, 3}));
    EXPECT_EQ(whole.layout.terms[2], terms.layout.terms[3]);
    Lighting lighting{light_of(3, 2)};
    lighting.lamps = {{1, 0.5f, 2}, {2, 1, 0}};
    const auto expected = exit_radiance(terms, lighting), lit = exit_radiance(whole, lighting);
    for (std::size_t p = 0; p < 20; ++p)
        EXPECT_LT(glm::distance(lit[p], expected[p]), 1e-4f);
    EXPECT_LT(relative_l2(whole, terms, std::vector<float>(20, 1.0f)), 1e-6);
    Transfer other = terms;
    other.layout.terms[3].name = "green";
    EXPECT_THROW(relative_l2(terms, other, std::vector<float>(20, 1.0f)), Error);
}

TEST(MeanVisibility, CountsNoLamps) {
    Transfer transfer = transfer_of(with_two_lamps(1), 1, 10);
    transfer.vectors = {0.5f, 0.1f, 0.2f, 0.3f, 9, 9, 9, 9};
    EXPECT_NEAR(mean_visibility(transfer, std::vector<float>{1}), 0.7 / kY00, 1e-6);
}

TEST(LightColumns, SunsAreExcludedOnlyFromDirectLight) {
    const Light sky = light_of(4, 1), suns = light_of(3, 2);
    for (const TransferLayout& layout :
         {direct_and_indirect(3, 1, 3), layout_of_one(3, 1, TermKind::direct),
          layout_of_one(3, 3, TermKind::indirect), layout_of_one(3, 1, TermKind::combined)}) {
        const std::vector<glm::vec3> columns = light_columns(layout, Lighting{sky, suns});
        ASSERT_EQ(columns.size(), 9 * layout.terms.size());
        for (std::size_t term = 0; term < layout.terms.size(); ++term)
            for (std::size_t i = 0; i < 9; ++i)
                EXPECT_EQ(columns[9 * term + i], layout.terms[term].kind == TermKind::direct
                                                     ? sky.coefficients[i]
                                                     : sky.coefficients[i] + suns.coefficients[i]);
        for (std::size_t i = 0; i < 9 * layout.terms.size(); ++i)
            EXPECT_EQ(light_columns(layout, {sky})[i], sky.coefficients[i % 9]);
    }
    EXPECT_THROW(light_columns(direct_and_indirect(4, 1, 1), Lighting{sky, suns}), Error);
    EXPECT_THROW(light_columns(direct_and_indirect(5, 1, 1), {sky}), Error);
}

TEST(ExitRadiance, SumsTermsUnderTheirLight) {
    const Light sky = light_of(4, 3), suns = light_of(4, 4);
    for (const auto& [direct, indirect] : {std::pair(1, 3), std::pair(3, 1)}) {
        const Transfer both = transfer_of(direct_and_indirect(4, direct, indirect), 30, 5);
        Transfer first = zero_transfer(4, direct, 30), second = zero_transfer(4, indirect, 30);
        for (std::size_t p = 0; p < 30; ++p) {
            const auto vector = both.vector(p);
            std::copy_n(vector.begin(), first.dimension(), first.vector(p).begin());
            std::copy_n(vector.end() - static_cast<std::ptrdiff_t>(second.dimension()), second.dimension(),
                        second.vector(p).begin());
        }
        const auto lit = exit_radiance(both, Lighting{sky, suns}), of_first = exit_radiance(first, sky),
                   of_second = exit_radiance(second, sum(sky, suns));
        for (std::size_t p = 0; p < 30; ++p)
            EXPECT_LT(glm::distance(lit[p], of_first[p] + of_second[p]), 1e-4f);
    }
}

TEST(CombinedTransfer, EqualsTheSeparateTermsUnderOneSky) {
    const Light sky = light_of(5, 6);
    for (const auto& [direct, indirect] :
         {std::pair(1, 1), std::pair(1, 3), std::pair(3, 1), std::pair(3, 3)}) {
        const Transfer terms = transfer_of(direct_and_indirect(5, direct, indirect), 40, 7);
        const Transfer whole = as_combined(terms);
        EXPECT_EQ(whole.layout, layout_of_one(5, std::max(direct, indirect)));
        const auto expected = exit_radiance(terms, sky), lit = exit_radiance(whole, sky);
        for (std::size_t p = 0; p < 40; ++p)
            EXPECT_LT(glm::distance(lit[p], expected[p]), 1e-4f);
    }
}

TEST(MeanVisibility, SumsTheTerms) {
    Transfer transfer = zero_transfer(direct_and_indirect(1, 1, 3), 2);
    transfer.vectors = {0.5f, 0.1f, 0.2f, 0.3f, 0.25f, 0, 0, 0};
    for (float& v : transfer.vectors)
        v *= static_cast<float>(kY00);
    EXPECT_NEAR(mean_visibility(transfer, std::vector<float>{3, 1}), (3 * (0.5 + 0.2) + 0.25) / 4, 1e-6);
}

TEST(RelativeL2, CountsAGreyTermForEachColorWithColoredTerms) {
    Transfer reference = zero_transfer(direct_and_indirect(1, 1, 3), 1), other = reference;
    reference.vectors = {2, 1, 1, 1};
    other.vectors = {2.5f, 1, 1, 1.25f};
    EXPECT_NEAR(relative_l2(reference, other, std::vector<float>{1}),
                std::sqrt((3 * 0.25 + 0.0625) / (3 * 4 + 3)), 1e-7);
}

} // namespace
} // namespace prt

// Suns between the keys of a light set.

#include "prt/light_set.h"

#include "prt/support/error.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prt {
namespace {

glm::dvec3 unit_vector(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

TransferPart key(const std::string& name, const glm::dvec3& towards) {
    return {PartKind::lamp, 1, name, {}, glm::vec3(towards)};
}

/// A lamp, and keys behind it.
TransferLayout layout_of(const std::vector<glm::dvec3>& keys) {
    TransferLayout layout{2, {{PartKind::direct, 1}, {PartKind::lamp, 3, "lamp"}}};
    for (std::size_t k = 0; k < keys.size(); ++k)
        layout.parts.push_back(key("key " + std::to_string(k), keys[k]));
    return layout;
}

/// The sum of the directions of all keys, weighted by what `sun` makes of them.
glm::dvec3 sum_of_keys(const TransferLayout& layout, std::span<const glm::vec3> strengths) {
    glm::dvec3 sum(0);
    for (std::size_t k = 0; k < strengths.size(); ++k)
        if (const auto& towards = layout.lamp_parts()[k].towards)
            sum += static_cast<double>(strengths[k].g) * glm::dvec3(*towards);
    return sum;
}

/// Whatever the normal: its irradiance is the product with the sum of the directions.
TEST(LightSet, LightsAsTheSunDoesBetweenItsKeys) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share(0, 1);
    for (int trial = 0; trial < 200; ++trial) {
        const glm::dvec3 a = unit_vector(random), c = unit_vector(random);
        glm::dvec3 b = unit_vector(random);
        b = glm::dot(a, b) < 0 ? -b : b;
        const double t = share(random);
        const glm::dvec3 sun = glm::normalize((1 - t) * a + t * b);
        const TransferLayout layout = layout_of({c, a, b});
        std::vector<glm::vec3> strengths(4, glm::vec3(0));
        EXPECT_NEAR(add_sun(layout, {glm::vec3(sun), {2, 3, 4}}, strengths), 0, 1e-3);
        EXPECT_LT(glm::distance(sum_of_keys(layout, strengths), 3.0 * sun), 1e-4);
        EXPECT_EQ(strengths[0], glm::vec3(0)); // no key
    }
}

/// The nearest place of an arc in a plane is the direction's projection.
TEST(LightSet, IsLitFromTheNearestPlaceOfItsArc) {
    const TransferLayout layout = layout_of({{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}});
    const double off = 0.3, along = 0.7;
    const glm::dvec3 place(std::cos(along), std::sin(along), 0),
        sun = std::cos(off) * place + glm::dvec3(0, 0, std::sin(off));
    std::vector<glm::vec3> strengths(4, glm::vec3(0));
    EXPECT_NEAR(add_sun(layout, {glm::vec3(sun), glm::vec3(1)}, strengths), off, 1e-6);
    EXPECT_LT(glm::distance(sum_of_keys(layout, strengths), place), 1e-6);
    EXPECT_EQ(strengths[3], glm::vec3(0));
}

TEST(LightSet, HasNeighboursWhateverStandsBetweenThem) {
    TransferLayout layout = layout_of({{1, 0, 0}, {0, 1, 0}});
    layout.parts.insert(layout.parts.begin() + 3, {PartKind::lamp, 1, "other"});
    std::vector<glm::vec3> strengths(4, glm::vec3(0));
    add_sun(layout, {glm::normalize(glm::vec3(1, 1, 0)), glm::vec3(1)}, strengths);
    EXPECT_NEAR(strengths[1].r, std::sqrt(0.5), 1e-6);
    EXPECT_EQ(strengths[2].r, 0);
    EXPECT_NEAR(strengths[3].r, std::sqrt(0.5), 1e-6);
}

TEST(LightSet, EndsAtItsFirstAndLastKey) {
    const TransferLayout layout = layout_of({{1, 0, 0}, {0, 1, 0}});
    std::vector<glm::vec3> strengths(3, glm::vec3(0));
    const glm::dvec3 sun(std::cos(0.4), -std::sin(0.4), 0);
    EXPECT_NEAR(add_sun(layout, {glm::vec3(sun), glm::vec3(1, 2, 3)}, strengths), 0.4, 1e-6);
    EXPECT_EQ(strengths[1], glm::vec3(1, 2, 3));
    EXPECT_EQ(strengths[2], glm::vec3(0));
}

TEST(LightSet, AddsItsSunsToWhatShines) {
    const TransferLayout layout = layout_of({{0, 1, 0}});
    std::vector<glm::vec3> strengths = {glm::vec3(5), glm::vec3(1)};
    EXPECT_NEAR(add_sun(layout, {{0, 1, 0}, glm::vec3(2)}, strengths), 0, 1e-6);
    EXPECT_EQ(strengths[0], glm::vec3(5));
    EXPECT_EQ(strengths[1], glm::vec3(3));
}

/// The wall that only one of two keys sees gets no more than twice the sun's irradiance, wherever they stand.
TEST(LightSet, NeverShinesFarTooBright) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 500; ++trial) {
        const TransferLayout layout =
            layout_of({unit_vector(random), unit_vector(random), unit_vector(random)});
        std::vector<glm::vec3> strengths(4, glm::vec3(0));
        add_sun(layout, {glm::vec3(unit_vector(random)), glm::vec3(1)}, strengths);
        for (const glm::vec3& strength : strengths)
            EXPECT_LE(strength.r, 1.0001f);
    }
}

TEST(LightSet, OfKeysInOnePlaceOrOppositeIsFinite) {
    for (const glm::dvec3& second : {glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0)}) {
        const TransferLayout layout = layout_of({{0, 1, 0}, second});
        std::vector<glm::vec3> strengths(3, glm::vec3(0));
        EXPECT_NEAR(add_sun(layout, {{1, 0, 0}, glm::vec3(1)}, strengths), std::acos(0.0), 1e-6);
        EXPECT_NEAR(glm::length(sum_of_keys(layout, strengths)), 1, 1e-6);
    }
}

TEST(LightSet, IsDarkUntilItIsSet) {
    const TransferLayout layout = layout_of({{0, 1, 0}});
    EXPECT_EQ(strengths_of_scene(layout), (std::vector{glm::vec3(1), glm::vec3(0)}));
    const auto columns = light_columns(layout, std::vector<glm::vec3>(4, glm::vec3(7)));
    EXPECT_EQ(columns[4], glm::vec3(1));
    EXPECT_EQ(columns[5], glm::vec3(0));
}

TEST(LightSet, ThatIsNotThereIsSaidSo) {
    const TransferLayout layout = layout_of({});
    std::vector<glm::vec3> strengths(1, glm::vec3(1));
    EXPECT_FALSE(has_light_set(layout));
    EXPECT_THROW(add_sun(layout, {}, strengths), Error);
}

TEST(LightSet, OfKeysThatHaveNoDirectionIsRefused) {
    EXPECT_NO_THROW(check_layout(layout_of({{0, 1, 0}})));
    EXPECT_THROW(check_layout(layout_of({{0, 2, 0}})), Error);
    EXPECT_THROW(check_layout(layout_of({{0, NAN, 0}})), Error);
    TransferLayout sky{2, {{PartKind::direct, 1}}};
    sky.parts[0].towards = glm::vec3(0, 1, 0);
    EXPECT_THROW(check_layout(sky), Error);
    TransferLayout group = layout_of({{0, 1, 0}});
    group.parts.back().members = {"a"};
    EXPECT_THROW(check_layout(group), Error);
}

} // namespace
} // namespace prt

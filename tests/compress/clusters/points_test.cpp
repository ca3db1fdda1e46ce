// Tests blocks of points: as floats, and rounded to 16 bits.

#include "compress/clusters/points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prt {
namespace {

constexpr std::size_t kReceivers = 5000;

struct Setting {
    Transfer transfer = zero_transfer(3, 1, kReceivers);
    std::vector<glm::vec3> normals;
    PredictorCoordinates predictors;
    Frame frame;

    Setting() {
        std::mt19937 random(4);
        std::normal_distribution<float> normal;
        for (std::size_t p = 0; p < kReceivers; ++p) {
            for (std::size_t i = 0; i < transfer.dimension(); ++i)
                transfer.vector(p)[i] = normal(random) * std::pow(0.7f, static_cast<float>(i));
            normals.emplace_back(normal(random), normal(random), normal(random));
        }
        predictors = {{{PredictorKind::normal, glm::vec3(0), glm::vec3(0.5f)}}, {normals}};
        frame = fit_frame(transfer, std::vector<float>(kReceivers, 1.0f / kReceivers),
                          plain_metric(transfer.layout), 0, 1);
    }
    PointBlocks points(double max_rounding, int threads = 1) const {
        return {transfer, frame, predictors, threads, max_rounding};
    }
};

TEST(Points, RoundingAddsTheReportedError) {
    const Setting setting;
    const PointBlocks exact = setting.points(0), rounded = setting.points(1);
    ASSERT_TRUE(exact.rounded.empty());
    ASSERT_TRUE(rounded.values.empty());
    EXPECT_EQ(exact.rounding(), 0);
    double error = 0;
    for (std::size_t p = 0; p < kReceivers; ++p)
        for (std::size_t i = 0; i < exact.width(); ++i) {
            const double difference =
                static_cast<double>(exact.coordinate(p, i)) - static_cast<double>(rounded.coordinate(p, i));
            const double step = static_cast<double>(
                rounded.steps[p / (kLanes * PointBlocks::kStepBlocks) * rounded.width() + i]);
            EXPECT_LE(std::abs(difference), 0.505 * step); // floats of 32767 steps err by 1/512 of one
            error += i < exact.dimension ? difference * difference / kReceivers : 0;
        }
    EXPECT_GT(rounded.rounding(), 0);
    EXPECT_NEAR(error, rounded.rounding(), 0.05 * rounded.rounding()); // 45 000 draws, evenly over a step
}

TEST(Points, RemainFloatsIfRoundingExceedsTheLimit) {
    const Setting setting;
    const double rounding = setting.points(1).rounding();
    EXPECT_TRUE(setting.points(1.01 * rounding).values.empty());
    const PointBlocks exact = setting.points(0.99 * rounding);
    EXPECT_EQ(exact.values, setting.points(0).values);
    EXPECT_TRUE(exact.rounded.empty());
    EXPECT_EQ(exact.rounding(), 0);
}

TEST(Points, DoNotDependOnStorage) {
    const Setting setting;
    for (const double max_rounding : {0.0, 1.0}) {
        PointBlocks points = setting.points(max_rounding);
        EXPECT_EQ(points.rounded, setting.points(max_rounding, 3).rounded);
        EXPECT_EQ(points.values, setting.points(max_rounding, 3).values);
        const std::vector<float> scales = {2, 3, 5};
        const float before = points.coordinate(77, points.dimension + 1);
        points.scale_predictors(scales);
        EXPECT_FLOAT_EQ(points.coordinate(77, points.dimension + 1), 3 * before);
        const std::vector<std::uint32_t> some = {4999, 17, 1023, 1024, 0};
        std::vector<float> gathered(points.width() * kLanes), room(points.width() * kLanes),
            copied(points.width());
        points.gather(some, gathered.data());
        for (std::size_t s = 0; s < some.size(); ++s) {
            points.copy_point(some[s], copied.data());
            const float* block = points.block(some[s] / kLanes, room.data());
            for (std::size_t i = 0; i < points.width(); ++i) {
                EXPECT_EQ(gathered[i * kLanes + s], copied[i]);
                EXPECT_EQ(block[i * kLanes + some[s] % kLanes], copied[i]);
            }
        }
    }
}

} // namespace
} // namespace prt

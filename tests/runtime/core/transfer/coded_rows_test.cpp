// Tests entropy-coded rows of bases.

#include "prt/core/clustered_bases.h"

#include "prt/core/error.h"
#include "runtime/core/support/bits.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace prt {
namespace {

TEST(Bits, RoundTripInOrder) {
    std::mt19937 random(2);
    std::vector<std::pair<std::uint32_t, int>> numbers;
    BitWriter writer;
    for (int i = 0; i < 500; ++i) {
        const int width = static_cast<int>(random() % 33);
        const auto value =
            static_cast<std::uint32_t>(random()) & static_cast<std::uint32_t>((1ull << width) - 1);
        numbers.emplace_back(value, width);
        writer.write(value, width);
    }
    const std::vector<std::byte> bytes = writer.take();
    BitReader reader(bytes);
    for (const auto& [value, width] : numbers) {
        ASSERT_TRUE(reader.has(width));
        EXPECT_EQ(reader.read(width), value);
    }
    EXPECT_FALSE(reader.has(8));
}

TEST(CodedRows, RoundTripExactly) {
    std::mt19937 random(3);
    for (const std::size_t columns : {1u, 5u, 36u}) {
        std::vector<std::int32_t> values;
        for (std::size_t r = 0; r < 40; ++r)
            for (std::size_t i = 0; i < columns; ++i) {
                const int bits = static_cast<int>(random() % 15); // from zero to the widest
                values.push_back(static_cast<std::int32_t>(random() % (1u << bits)) - (1 << bits) / 2);
            }
        values[0] = -16384;
        values.back() = 16383;
        const RowCode code = encode_rows(values, columns);
        EXPECT_EQ(decode_rows(code, 40), values);
    }
}

TEST(CodedRows, SmallColumnsCostLittle) {
    // Rows whose values halve from column to column, with a size that varies from row to row: the code needs
    // about the bits of the values, and the level.
    std::mt19937 random(4);
    std::vector<std::int32_t> values;
    for (int r = 0; r < 200; ++r)
        for (int i = 0; i < 12; ++i) {
            const int most = (1 << (4 + r % 8)) >> i;
            values.push_back(
                most == 0 ? 0 : static_cast<std::int32_t>(random() % static_cast<unsigned>(2 * most)) - most);
        }
    std::size_t plain = 0;
    for (int r = 0; r < 200; ++r)
        for (int i = 0; i < 12; ++i)
            plain += static_cast<std::size_t>(std::max(0, 5 + r % 8 - i));
    // And the bits needed to adapt the models to equal frequencies of all sizes.
    EXPECT_LT(8 * encode_rows(values, 12).bits.size(), plain + 200 * 5 + 700);
}

TEST(CodedRows, ZerosNeedOnlyTheirLevels) {
    const std::vector<std::int32_t> zeros(70, 0);
    EXPECT_EQ(encode_rows(zeros, 7).bits.size(), 8u); // and the end of the stream
    EXPECT_EQ(decode_rows(encode_rows(zeros, 7), 10), zeros);
    EXPECT_TRUE(decode_rows(encode_rows({}, 0), 10).empty());
}

TEST(CodedRows, ApproachTheirEntropy) {
    // A Gaussian of deviation s in whole numbers has log2(s sqrt(2 pi e)) bits.
    std::mt19937 random(5);
    for (const double deviation : {2.0, 20.0}) {
        std::normal_distribution<double> gaussian(0, deviation);
        std::vector<std::int32_t> values(40000);
        for (std::int32_t& value : values)
            value = static_cast<std::int32_t>(std::lround(gaussian(random)));
        const double entropy = std::log2(deviation * std::sqrt(2 * M_PI * M_E));
        const RowCode code = encode_rows(values, 20);
        EXPECT_EQ(decode_rows(code, 2000), values);
        EXPECT_LT(static_cast<double>(8 * code.bits.size()), (entropy + 0.35) * 40000);
    }
}

TEST(CodedRows, CarriesPropagateThroughPreviousBytes) {
    // Values that the models learn to expect, with one now and then that they do not.
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        std::vector<std::int32_t> values(600, 1);
        for (std::int32_t& value : values)
            if (random() % 61 == 0)
                value = static_cast<std::int32_t>(random() % 255) - 127;
        EXPECT_EQ(decode_rows(encode_rows(values, 3), 200), values) << seed;
    }
}

TEST(CodedRows, TruncatedRowsAreRejected) {
    RowCode code = encode_rows(std::vector<std::int32_t>{100, -100, 7, 8}, 2);
    code.bits.pop_back();
    EXPECT_THROW(decode_rows(code, 2), Error);
}

TEST(CodedBases, AreTheOriginInMeansAndScaledSumsOfTheAxes) {
    // Two clusters with two directions and with none, and one with one: rows 0, 3 and 4 are means.
    const std::vector<int> components = {2, 0, 1};
    const std::array<bool, 6> is_mean = {true, false, false, true, true, false};
    constexpr std::size_t kAxes = 3, kDimension = 5;
    std::mt19937 random(4);
    const auto numbers = [&](std::size_t count) {
        std::vector<std::int32_t> result(count);
        for (std::int32_t& number : result)
            number = static_cast<std::int32_t>(random() % 201) - 100;
        return result;
    };
    const std::vector<std::int32_t> axes = numbers(kAxes * kDimension),
                                    values = numbers(is_mean.size() * kAxes);
    const CodedBases coded{{1, -2, 3, 0, 5},
                           {0.5f, 0.25f, 2},
                           0.125f,
                           encode_rows(axes, kDimension),
                           encode_rows(values, kAxes)};
    const std::vector<float> rows = decode_bases(coded, components);
    ASSERT_EQ(rows.size(), is_mean.size() * kDimension);
    for (std::size_t row = 0; row < is_mean.size(); ++row)
        for (std::size_t i = 0; i < kDimension; ++i) {
            double sum = is_mean[row] ? static_cast<double>(coded.origin[i]) : 0;
            for (std::size_t a = 0; a < kAxes; ++a)
                sum += (is_mean[row] ? 1 : 2) * static_cast<double>(coded.step) *
                       static_cast<double>(coded.scales[a]) * values[row * kAxes + a] *
                       axes[a * kDimension + i];
            EXPECT_EQ(static_cast<double>(rows[row * kDimension + i]), sum)
                << row; // floats hold these numbers
        }
    // Five, three and one floats, a byte for each column, and the bits.
    EXPECT_EQ(coded_bytes(coded),
              (5 + 3 + 1) * 4 + 5 + coded.axes.bits.size() + 3 + coded.values.bits.size());
    CodedBases scaled = coded;
    scaled.units = {1, 2, 0.5f, 1024, 1};
    const std::vector<float> wide = decode_bases(scaled, components);
    for (std::size_t v = 0; v < rows.size(); ++v) {
        const std::size_t i = v % kDimension;
        const float begin = is_mean[v / kDimension] ? coded.origin[i] : 0;
        EXPECT_EQ(wide[v], begin + scaled.units[i] * (rows[v] - begin));
    }
    EXPECT_EQ(coded_bytes(scaled), coded_bytes(coded) + 5 * 4);
    scaled.units.pop_back();
    EXPECT_THROW(decode_bases(scaled, components), Error);
    CodedBases other = coded;
    other.origin.push_back(0);
    EXPECT_THROW(decode_bases(other, components), Error);
}

TEST(CodedBases, HaveSeparateStepsPerClusterAndAxisGroup) {
    const std::vector<int> components = {1, 0};
    const std::vector<std::int32_t> axes = {1, 0, 0, 0, 1, 0, 0, 0, 1}, // three, each of one number
        values = {5, 6, 7, -1, -2, -3, 9, 10, 11};                      // mean, direction; mean
    CodedBases coded{{100, 200, 300}, {1, 2, 4}, 0.5f, encode_rows(axes, 3), encode_rows(values, 3)};
    coded.exponents = {{1, 2}, encode_rows(std::vector<std::int32_t>{0, 3, 5, -1}, 2)};
    EXPECT_EQ(decode_bases(coded, components),
              (std::vector<float>{100 + 0.5f * 5, 200 + 4.0f * 2 * 6, 300 + 4.0f * 4 * 7, // steps 0.5, 4, 4
                                  -2 * 0.5f, -2 * 4.0f * 2 * 2, -2 * 4.0f * 4 * 3,        // twice as much
                                  100 + 16.0f * 9, 200 + 0.25f * 2 * 10, 300 + 0.25f * 4 * 11}));
    EXPECT_EQ(coded_bytes(coded), (3 + 3 + 1) * 4 + 3 + coded.axes.bits.size() + 3 +
                                      coded.values.bits.size() + 2 + 2 + coded.exponents.code.bits.size());
    for (const std::vector<int>& wrong : {std::vector<int>{1, 1}, {1, 3}, {3}, {1, 1, 1}, {-1, 4}}) {
        coded.exponents.axes = wrong;
        EXPECT_THROW(decode_bases(coded, components), Error);
    }
}

TEST(CodedBases, RowsOfPredictorsHaveTheStepOfMeansAndNoOrigin) {
    // a cluster with one direction, then one without
    const std::vector<std::int32_t> values = {5, 6, 7, 8, 9, -5, -6, -7, -8};
    const CodedBases coded{
        {100}, {1}, 0.5f, encode_rows(std::vector<std::int32_t>{2}, 1), encode_rows(values, 1)};
    EXPECT_EQ(decode_bases(coded, {1, 0}, 3), (std::vector<float>{105, 6, 7, 8, 18, 95, -6, -7, -8}));
}

} // namespace
} // namespace prt

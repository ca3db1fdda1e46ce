#include "prt/coded_rows.h"

#include "prt/support/bits.h"
#include "prt/support/error.h"

#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace {

TEST(Bits, ComeBackInTheirOrder) {
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

TEST(CodedRows, ComeBackExactly) {
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
        EXPECT_EQ(code.bits.size(), (coded_bits(values, columns) + 7) / 8);
    }
}

TEST(CodedRows, SmallColumnsCostLittle) {
    // Rows whose values fall by half from column to column, at sizes that differ from row to row: about as
    // many bits as the values have, and the level.
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
    EXPECT_LT(coded_bits(values, 12), plain + 200 * 5);
}

TEST(CodedRows, ZerosTakeTheirLevelsAlone) {
    const std::vector<std::int32_t> zeros(70, 0);
    EXPECT_EQ(coded_bits(zeros, 7), 40u);
    EXPECT_EQ(decode_rows(encode_rows(zeros, 7), 10), zeros);
    EXPECT_TRUE(decode_rows(encode_rows({}, 0), 10).empty());
}

TEST(CodedRows, ThatEndTooEarlyAreRefused) {
    RowCode code = encode_rows(std::vector<std::int32_t>{100, -100, 7, 8}, 2);
    code.bits.pop_back();
    EXPECT_THROW(decode_rows(code, 2), Error);
}

} // namespace
} // namespace prt

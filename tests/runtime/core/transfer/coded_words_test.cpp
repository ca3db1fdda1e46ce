// Tests entropy-coded words of receivers.

#include "prt/core/clustered_transfer.h"
#include "runtime/core/transfer/coded_words.h"

#include "prt/core/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace prt {
namespace {

/// Returns clusters with random numbers of components; bits of weights are in the range `widths`.
WordLayout random_layout(std::size_t clusters, std::size_t components, std::pair<int, int> widths,
                         std::mt19937& random) {
    ClusteredBases bases;
    std::size_t most = 0;
    const int cluster_bits = std::bit_width(static_cast<unsigned>(clusters - 1));
    for (std::size_t k = 0; k < clusters; ++k) {
        bases.components.push_back(static_cast<int>(k == 0 ? components : random() % (components + 1)));
        std::size_t bits = static_cast<std::size_t>(cluster_bits);
        for (int j = 0; j < bases.components.back(); ++j) {
            bases.bits.push_back(static_cast<std::uint8_t>(
                widths.first +
                static_cast<int>(random() % static_cast<unsigned>(widths.second - widths.first + 1))));
            bits += bases.bits.back();
        }
        most = std::max(most, bits);
    }
    return {cluster_layouts(bases), cluster_bits, std::max(1, static_cast<int>((most + 31) / 32))};
}

/// Returns words whose weights change by up to `noise` 65536ths of their range from receiver to receiver.
std::vector<std::uint32_t> random_words(const WordLayout& layout, std::size_t receivers, unsigned noise,
                                        std::mt19937& random) {
    const auto stride = static_cast<std::size_t>(layout.words);
    std::vector<std::uint32_t> words(receivers * stride), values(kMaxPackedComponents);
    std::vector<std::uint32_t> last(kMaxPackedComponents, 32768);
    std::uint32_t cluster = 0;
    for (std::size_t v = 0; v < receivers; ++v) {
        if (random() % 4 == 0)
            cluster = static_cast<std::uint32_t>(random() % layout.clusters.size());
        const ClusterLayout& own = layout.clusters[cluster];
        for (std::size_t j = 0; j < own.components; ++j) {
            const auto width = 1 + (own.widths[j / 8] >> (4 * (j % 8)) & 15);
            last[j] = static_cast<std::uint32_t>(last[j] + random() % (noise + 1) - noise / 2) % 65536;
            values[j] = last[j] >> (16 - width);
        }
        pack_words(cluster, layout.cluster_bits, own, values, std::span(words).subspan(v * stride, stride));
    }
    return words;
}

/// Returns random triangles: with degenerate ones, edges of many triangles, and unused vertices.
std::vector<std::uint32_t> random_triangles(std::size_t receivers, std::size_t count, std::mt19937& random) {
    std::vector<std::uint32_t> triangles;
    for (std::size_t t = 0; t < count; ++t) {
        const auto first = random() % receivers;
        for (int i = 0; i < 3; ++i)
            triangles.push_back(static_cast<std::uint32_t>(std::min(first + random() % 9, receivers - 1)));
    }
    return triangles;
}

/// A chain of receivers, of one weight of 6 bits each.
struct Chain {
    WordLayout layout;
    std::vector<EarlierNeighbors> neighbors;
    std::vector<std::uint32_t> words;
};

/// Weights go up by 0 to `steps` - 1 each time, and begin again behind the largest.
Chain chain(std::size_t receivers, unsigned steps) {
    std::mt19937 random(1);
    Chain chain{random_layout(1, 1, {6, 6}, random), earlier_neighbors({}, receivers), {}};
    for (std::size_t v = 0; v < receivers; ++v)
        chain.words.push_back(((v > 0 ? chain.words.back() : 0) + random() % steps) % 64);
    return chain;
}

TEST(CodedWords, RoundTripExactly) {
    std::mt19937 random(7);
    for (const std::size_t clusters : {1u, 2u, 7u, 300u})
        for (const auto& [components, widths] : {std::pair{std::size_t{5}, std::pair{1, 6}},
                                                 {std::size_t{16}, std::pair{1, 16}},
                                                 {std::size_t{0}, std::pair{1, 1}},
                                                 {std::size_t{3}, std::pair{16, 16}}})
            for (const std::size_t receivers : {1u, 2u, 3u, 500u})
                for (const unsigned noise : {0u, 3000u, 65535u}) {
                    const WordLayout layout = random_layout(clusters, components, widths, random);
                    const auto words = random_words(layout, receivers, noise, random);
                    const auto neighbors =
                        earlier_neighbors(random_triangles(receivers, receivers, random), receivers);
                    ASSERT_TRUE(can_code_words(layout, words));
                    ASSERT_EQ(decode_words(encode_words(layout, neighbors, words), layout, neighbors), words);
                }
}

TEST(CodedWords, BlocksDoNotDependOnThreads) {
    std::mt19937 random(8);
    const WordLayout layout = random_layout(40, 3, {1, 9}, random);
    const std::size_t receivers = 2 * 16384 + 1; // the last block has one
    const auto words = random_words(layout, receivers, 3000, random);
    const auto neighbors = earlier_neighbors(random_triangles(receivers, receivers, random), receivers);
    const WordCode code = encode_words(layout, neighbors, words);
    for (const int threads : {1, 3})
        EXPECT_EQ(decode_words(code, layout, neighbors, threads), words);
    for (const std::size_t i : {0u, 4u, 8u}) { // lengths of blocks
        WordCode wrong = code;
        wrong.bits[i] ^= std::byte{2};
        EXPECT_THROW(decode_words(wrong, layout, neighbors), Error);
    }
}

TEST(CodedWords, AreEmptyWithoutReceivers) {
    const Chain none = chain(0, 1);
    EXPECT_TRUE(decode_words(encode_words(none.layout, {}, {}), none.layout, {}).empty());
}

TEST(CodedWords, ApproachTheirEntropy) {
    constexpr std::size_t kReceivers = 20'000;
    for (const unsigned bits : {0u, 1u, 3u, 5u}) {
        const Chain given = chain(kReceivers, 1u << bits);
        const WordCode code = encode_words(given.layout, given.neighbors, given.words);
        const double entropy = static_cast<double>(kReceivers * bits) / 8;
        // Two blocks: lengths and four states; frequencies are rounded to 1024ths: within a percent.
        EXPECT_LT(static_cast<double>(code.bits.size()), 1.01 * entropy + 60) << bits;
        EXPECT_GT(static_cast<double>(code.bits.size()), 0.98 * entropy) << bits;
        EXPECT_LT(coded_bytes(code.frequencies), 250u);
    }
}

TEST(CodedWords, ArePredictedByThreeEarlierNeighbors) {
    // Vertex 4 has all others as neighbours, 3 has three of them; a fourth neighbour is ignored.
    const std::vector<std::uint32_t> triangles = {0, 1, 4, 4, 2, 3, 3, 0, 2, 3, 3, 1};
    const std::vector<EarlierNeighbors> expected = {{0, 0, 0}, {0, 1, 1}, {0, 2, 2}, {2, 0, 1}, {0, 1, 2}};
    EXPECT_EQ(earlier_neighbors(triangles, 5), expected);
}

TEST(CodedWords, DoNotDependOnTriangleRotation) {
    std::mt19937 random(9);
    std::vector<std::uint32_t> triangles = random_triangles(100, 300, random);
    const auto neighbors = earlier_neighbors(triangles, 100);
    for (std::size_t t = 0; t < triangles.size(); t += 3)
        std::rotate(triangles.begin() + static_cast<std::ptrdiff_t>(t),
                    triangles.begin() + static_cast<std::ptrdiff_t>(t + 1 + t % 2),
                    triangles.begin() + static_cast<std::ptrdiff_t>(t + 3));
    EXPECT_EQ(earlier_neighbors(triangles, 100), neighbors);
    EXPECT_THROW(earlier_neighbors(triangles, 50), Error);
}

TEST(CodedWords, RejectBitsBehindTheWeights) {
    Chain given = chain(10, 4);
    EXPECT_TRUE(can_code_words(given.layout, given.words));
    given.words[7] |= 1u << 6;
    EXPECT_FALSE(can_code_words(given.layout, given.words));
    std::mt19937 random(2);
    const WordLayout layout = random_layout(5, 1, {2, 2}, random); // three bits: 5 to 7 are invalid clusters
    EXPECT_FALSE(can_code_words(layout, std::vector<std::uint32_t>{4, 5}));
}

TEST(CodedWords, TruncatedOrPaddedWordsAreRejected) {
    const Chain given = chain(300, 16);
    const WordCode code = encode_words(given.layout, given.neighbors, given.words);
    for (std::size_t size = 0; size < code.bits.size() + 3; ++size) {
        WordCode other = code;
        other.bits.resize(size);
        if (size != code.bits.size()) {
            EXPECT_THROW(decode_words(other, given.layout, given.neighbors), Error) << size;
        }
    }
    for (std::size_t size = 0; size + 3 < code.frequencies.bits.size(); ++size) {
        WordCode other = code;
        other.frequencies.bits.resize(size);
        EXPECT_THROW(decode_words(other, given.layout, given.neighbors), Error) << size;
    }
    WordCode narrow = code;
    narrow.frequencies.drops.pop_back();
    EXPECT_THROW(decode_words(narrow, given.layout, given.neighbors), Error);
}

TEST(CodedWords, DamageIsRejectedOrChangesWords) {
    std::mt19937 random(4);
    const WordLayout layout = random_layout(5, 6, {1, 9}, random);
    const auto words = random_words(layout, 200, 9000, random);
    const auto neighbors = earlier_neighbors(random_triangles(200, 300, random), 200);
    const WordCode code = encode_words(layout, neighbors, words);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < code.bits.size(); ++i) {
        WordCode damaged = code;
        damaged.bits[i] ^= static_cast<std::byte>(1 + random() % 255);
        try {
            const auto other = decode_words(damaged, layout, neighbors);
            EXPECT_NE(other, words);
            EXPECT_TRUE(can_code_words(layout, other));
        } catch (const Error& error) {
            ++refused;
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
    // Plain bits, and symbols of equal frequency, may change without being detected.
    EXPECT_GT(10 * refused, 9 * code.bits.size());
}

} // namespace
} // namespace prt

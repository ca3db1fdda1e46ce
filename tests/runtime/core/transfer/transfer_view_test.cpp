// Tests that transfer read block by block equals the complete transfer.

#include "prt/core/transfer_view.h"

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prt {
namespace {

Transfer read_in_blocks(const TransferView& view, std::size_t block) {
    Transfer all = zero_transfer(view.layout(), view.receivers());
    for (std::size_t p = 0; p < view.receivers(); p += block) {
        const std::size_t count = std::min(block, view.receivers() - p);
        view.read(p, std::span(all.vectors).subspan(p * view.dimension(), count * view.dimension()));
    }
    return all;
}

Transfer random_transfer(const TransferLayout& layout, std::size_t receivers) {
    Transfer transfer = zero_transfer(layout, receivers);
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (float& v : transfer.vectors)
        v = normal(random);
    return transfer;
}

const TransferLayout kTwoTerms{3, {{TermKind::direct, 1}, {TermKind::indirect, 3}}};

TEST(TransferView, ReadsEveryFiniteHalfExactly) {
    StoredTransfer stored{layout_of_one(1, 1), {}, {}};
    for (unsigned half = 0; half < 0x10000; ++half)
        if ((half & 0x7C00) != 0x7C00)
            stored.halves.push_back(static_cast<std::uint16_t>(half));
    const Transfer read = read_in_blocks(stored, 100);
    ASSERT_EQ(read.receivers(), 63488u);
    for (std::size_t p = 0; p < read.receivers(); ++p) {
        EXPECT_EQ(read.vectors[p], glm::unpackHalf1x16(stored.halves[p]));
        EXPECT_EQ(std::signbit(read.vectors[p]), (stored.halves[p] & 0x8000) != 0);
    }
}

TEST(TransferView, ReadsFloatsOfAllStorages) {
    const Transfer transfer = random_transfer(kTwoTerms, 31);
    const StoredTransfer stored{kTwoTerms, transfer.vectors, {}};
    for (const std::size_t block : {1u, 7u, 31u}) {
        EXPECT_EQ(read_in_blocks(transfer, block).vectors, transfer.vectors);
        EXPECT_EQ(read_in_blocks(stored, block).vectors, transfer.vectors);
    }
}

TEST(TransferView, ReadsTermsCombined) {
    const Transfer transfer = random_transfer(kTwoTerms, 31);
    const TransferView view = as_combined(TransferView(transfer));
    EXPECT_EQ(view.layout(), as_combined(kTwoTerms));
    for (const std::size_t block : {1u, 7u, 31u})
        EXPECT_EQ(read_in_blocks(view, block).vectors, as_combined(transfer).vectors);
}

TEST(TransferView, ReadsInAnotherOrder) {
    const Transfer transfer = random_transfer(kTwoTerms, 4);
    const std::vector<std::uint32_t> order = {2, 0, 3, 1};
    const TransferView view = in_order(transfer, std::vector(order)); // which is gone when it is read
    const Transfer read = read_in_blocks(view, 3);
    for (std::size_t p = 0; p < order.size(); ++p)
        EXPECT_TRUE(std::ranges::equal(read.vector(p), transfer.vector(order[p])));
}

} // namespace
} // namespace prt

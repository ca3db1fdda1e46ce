// Tests adjacency lists of edges.

#include "prt/core/adjacency.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace prt {
namespace {

TEST(Edges, AreUniqueAscendingAndJoinTwoReceivers) {
    const std::vector<Edge> edges = unique_edges({{2, 1}, {0, 3}, {1, 2}, {4, 4}, {3, 0}, {0, 1}});
    EXPECT_EQ(edges, (std::vector<Edge>{{0, 1}, {0, 3}, {1, 2}}));
}

TEST(Adjacency, ContainsBothEndsOfEveryEdge) {
    std::vector<Edge> edges; // pairs of numbers below 30 with product 1 modulo 7
    for (std::uint32_t a = 0; a < 30; ++a)
        for (std::uint32_t b = a + 1; b < 30; ++b)
            if (a * b % 7 == 1)
                edges.push_back({a, b});
    const Adjacency adjacency(edges, 30);
    EXPECT_EQ(adjacency.receivers(), 30u);
    EXPECT_EQ(adjacency.size(), 2 * edges.size());
    for (std::uint32_t a = 0; a < 30; ++a) {
        const auto neighbours = adjacency.of(a);
        EXPECT_EQ(neighbours.size(), adjacency.degree(a));
        EXPECT_TRUE(std::is_sorted(neighbours.begin(), neighbours.end()));
        for (std::uint32_t b = 0; b < 30; ++b)
            EXPECT_EQ(std::count(neighbours.begin(), neighbours.end(), b), a != b && a * b % 7 == 1);
    }
}

} // namespace
} // namespace prt

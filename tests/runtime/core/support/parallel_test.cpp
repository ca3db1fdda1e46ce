// Tests parallel loops.

#include "runtime/core/support/parallel.h"

#include "prt/core/error.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace prt {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceInAlignedBlocks) {
    for (const int threads : {1, 2, 5}) {
        std::vector<std::atomic<int>> visits(1003);
        parallel_for(visits.size(), 10, threads, [&](std::size_t begin, std::size_t end) {
            EXPECT_EQ(begin % 10, 0u);
            EXPECT_LE(end - begin, 10u);
            for (std::size_t i = begin; i < end; ++i)
                ++visits[i];
        });
        for (const auto& count : visits)
            EXPECT_EQ(count, 1);
    }
}

TEST(ParallelFor, EmptyRangesAreValid) {
    parallel_for(0, 16, 2, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelFor, RethrowsExceptionsOfTheBody) {
    EXPECT_THROW(parallel_for(100, 1, 3,
                              [](std::size_t begin, std::size_t) {
                                  if (begin == 42)
                                      throw Error("x");
                              }),
                 Error);
}

} // namespace
} // namespace prt

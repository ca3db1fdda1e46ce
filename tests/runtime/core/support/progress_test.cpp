// Tests progress and cancellation.

#include "prt/core/progress.h"

#include <gtest/gtest.h>

#include <vector>

namespace prt {
namespace {

TEST(Progress, NestedPartsFillTheirShare) {
    std::vector<double> reported;
    const Progress whole{[&](double share) { reported.push_back(share); }, {}};
    const Progress range = whole.range(0.5, 1).range(0, 0.5); // outlives the range that it is of
    range.update(0);
    range.update(0.5);
    range.update(1);
    EXPECT_EQ(reported, (std::vector<double>{0.5, 0.625, 0.75}));
    EXPECT_FALSE(Progress{}.range(0, 0.5).report);
}

TEST(Progress, StopsPartsWithoutFurtherReports) {
    std::stop_source source;
    bool reported = false;
    const Progress range = Progress{[&](double) { reported = true; }, source.get_token()}.range(0, 0.5);
    range.check();
    source.request_stop();
    EXPECT_THROW(range.check(), Cancelled);
    EXPECT_THROW(range.update(1), Cancelled);
    EXPECT_FALSE(reported);
}

} // namespace
} // namespace prt

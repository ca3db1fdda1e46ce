// Tests progress and cancellation.

#include "prt/support/progress.h"

#include <gtest/gtest.h>

#include <vector>

namespace prt {
namespace {

TEST(Progress, PartsOfPartsFillTheirShareOfTheWhole) {
    std::vector<double> reported;
    const Progress whole{[&](double share) { reported.push_back(share); }, {}};
    const Progress part = whole.part(0.5, 1).part(0, 0.5); // outlives the part that it is of
    part.update(0);
    part.update(0.5);
    part.update(1);
    EXPECT_EQ(reported, (std::vector<double>{0.5, 0.625, 0.75}));
    EXPECT_FALSE(Progress{}.part(0, 0.5).report);
}

TEST(Progress, StopsThePartsAndReportsNothingMore) {
    std::stop_source source;
    bool reported = false;
    const Progress part = Progress{[&](double) { reported = true; }, source.get_token()}.part(0, 0.5);
    part.check();
    source.request_stop();
    EXPECT_THROW(part.check(), Cancelled);
    EXPECT_THROW(part.update(1), Cancelled);
    EXPECT_FALSE(reported);
}

} // namespace
} // namespace prt

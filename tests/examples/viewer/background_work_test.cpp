// Work in the background, with threads that the sanitizer watches.

#include "core/background_work.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <thread>

namespace viewer {
namespace {

using Work = BackgroundWork<std::string>;

std::vector<std::string> collect_all(Work& work) {
    std::vector<std::string> all;
    for (bool busy = true; busy;) {
        busy = work.busy();
        std::ranges::move(work.collect(), std::back_inserter(all));
        std::this_thread::yield();
    }
    return all;
}

TEST(BackgroundWork, PostsFindingsInOrder) {
    Work work;
    work.start([](Work::Channel& channel) {
        for (const char* part : {"a", "b", "c"}) {
            channel.enter(Stage::reading, part);
            channel.progress().update(0.5);
            channel.post(part);
        }
    });
    EXPECT_EQ(collect_all(work), (std::vector<std::string>{"a", "b", "c"}));
}

TEST(BackgroundWork, PostsNoFindingsAfterReplacement) {
    std::atomic<bool> begun = false; // outlives the work; the work's destructor waits for it
    Work work;
    work.start([&](Work::Channel& channel) {
        for (;;) {
            begun = true;
            channel.post("first");
            channel.progress().update(0);
        }
    });
    while (!begun)
        std::this_thread::yield();
    work.start([](Work::Channel& channel) { channel.post("second"); });
    EXPECT_EQ(collect_all(work), std::vector<std::string>{"second"});
}

TEST(BackgroundWork, PostsNoFindingsAfterStop) {
    std::atomic<bool> begun = false; // outlives the work; the work's destructor waits for it
    Work work;
    work.start([&](Work::Channel& channel) {
        for (;;) {
            begun = true;
            channel.post("never taken");
            channel.progress().update(0);
        }
    });
    while (!begun)
        std::this_thread::yield();
    work.stop();
    EXPECT_FALSE(work.busy());
    EXPECT_TRUE(collect_all(work).empty());
}

} // namespace
} // namespace viewer

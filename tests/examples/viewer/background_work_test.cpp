#include "core/background_work.h"

#include "prt/support/error.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

namespace viewer {
namespace {

void collect_all(BackgroundWork& work) {
    while (work.busy()) {
        work.collect();
        std::this_thread::yield();
    }
    work.collect();
}

void fail_test(const std::string& message) {
    FAIL() << message;
}

TEST(BackgroundWork, PostsWhatItFindsInOrderToTheThreadThatCollects) {
    BackgroundWork work;
    std::string found; // without a lock: only the thread that collects touches it
    work.start(
        [&](BackgroundWork::Channel& channel) {
            for (const char* part : {"a", "b", "c"}) {
                channel.stage(part);
                channel.progress().update(0.5);
                channel.post([&found, part] { found += part; });
            }
        },
        fail_test);
    collect_all(work);
    EXPECT_EQ(found, "abc");
}

TEST(BackgroundWork, ThatIsStoppedPostsNothingMore) {
    BackgroundWork work;
    std::atomic<bool> begun = false;
    int found = 0;
    const auto endless = [&](BackgroundWork::Channel& channel) {
        for (;;) {
            begun = true;
            channel.post([&found] { ++found; });
            channel.progress().update(0);
        }
    };
    work.start(endless, fail_test);
    while (!begun)
        std::this_thread::yield();
    work.stop();
    const int before = found;
    collect_all(work);
    EXPECT_EQ(found, before);
}

TEST(BackgroundWork, TellsWhatFailed) {
    BackgroundWork work;
    std::string told;
    work.start([](BackgroundWork::Channel&) { throw prt::Error("no such file"); },
               [&told](const std::string& message) { told = message; });
    collect_all(work);
    EXPECT_EQ(told, "no such file");
}

} // namespace
} // namespace viewer

// Tests files that are written and published atomically.

#include "runtime/core/support/file.h"

#include "prt/core/error.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace prt {
namespace {

std::string text_of(const std::filesystem::path& path) {
    const auto bytes = read_file(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(ReadFile, ReportsErrors) {
    const test::TemporaryFolder folder;
    folder.file("empty", "");
    for (const auto& path : {folder / "missing", folder.path(), folder / "empty"})
        try {
            read_file(path);
            FAIL() << path;
        } catch (const Error& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with(path.string() + ": ")) << error.what();
        }
}

TEST(OutputFile, AppearsOnlyWhenCommitted) {
    const test::TemporaryFolder folder;
    {
        OutputFile file(folder / "a");
        file.write("new");
        EXPECT_FALSE(std::filesystem::exists(folder / "a"));
        file.commit();
    }
    EXPECT_EQ(text_of(folder / "a"), "new");
    EXPECT_EQ(folder.files(), 1u);
}

TEST(OutputFile, LeavesTheOldFileWhenAbandoned) {
    const test::TemporaryFolder folder;
    folder.file("a", "old");
    {
        OutputFile file(folder / "a");
        file.write("half");
    }
    EXPECT_EQ(text_of(folder / "a"), "old");
    EXPECT_EQ(folder.files(), 1u);
}

TEST(OutputFile, RejectsFoldersAndInvalidNames) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(OutputFile(folder.path()), Error);
    EXPECT_THROW(OutputFile(folder / "no/such/folder"), Error);
    EXPECT_THROW(OutputFile(folder / std::string(256, 'n')), Error);
}

TEST(OutputFile, FollowsLinksInsteadOfReplacingThem) {
    const test::TemporaryFolder folder;
    folder.file("target", "old");
    std::filesystem::create_symlink("target", folder / "link");
    std::filesystem::create_symlink("later", folder / "dangling");
    for (const char* name : {"link", "dangling"}) {
        OutputFile file(folder / name);
        file.write("new");
        file.commit();
        EXPECT_TRUE(std::filesystem::is_symlink(folder / name)) << name;
    }
    for (const char* name : {"target", "later"})
        EXPECT_EQ(read_file(folder / name).size(), 3u);
    EXPECT_EQ(std::to_integer<char>(read_file(folder / "target")[0]), 'n');
}

TEST(OutputFile, AcceptsTheLongestName) {
    const test::TemporaryFolder folder;
    for (const char* text : {"new", "newer"}) {
        OutputFile file(folder / std::string(255, 'n'));
        file.write(text);
        EXPECT_EQ(file.size(), std::string_view(text).size());
        file.commit();
        EXPECT_EQ(text_of(folder / std::string(255, 'n')), text);
    }
    EXPECT_EQ(folder.files(), 1u);
}

TEST(OutputFile, IsRemovedUnlessCommitted) {
    const test::TemporaryFolder folder;
    folder.file("old", "old");
    for (const char* name : {"old", "none"}) {
        OutputFile file(folder / name);
        file.write("new");
        file.finish();
        file.publish();
        EXPECT_EQ(text_of(folder / name), "new");
    }
    EXPECT_EQ(text_of(folder / "old"), "old");
    EXPECT_EQ(folder.files(), 1u);
}

TEST(OutputFile, WritesIntoPipesAndDevices) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    std::string read;
    std::jthread reader([&] { std::getline(std::ifstream(folder / "pipe"), read); });
    OutputFile pipe(folder / "pipe");
    pipe.write("new");
    pipe.commit();
    reader.join();
    EXPECT_EQ(read, "new");
    EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
    OutputFile nowhere("/dev/null");
    nowhere.write("new");
    nowhere.commit();
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    OutputFile full("/dev/full");
    full.write("new");
    EXPECT_THROW(full.commit(), Error);
}

/// Closes standard input during its lifetime, so that the next opened file has descriptor 0.
class NoStandardInput {
public:
    NoStandardInput() : kept_(::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3)) { ::close(STDIN_FILENO); }
    ~NoStandardInput() {
        if (kept_ >= 0)
            ::dup2(kept_, STDIN_FILENO);
        ::close(kept_);
    }
    NoStandardInput(const NoStandardInput&) = delete;

private:
    int kept_;
};

bool is_open(int descriptor) {
    return ::fcntl(descriptor, F_GETFD) >= 0;
}

TEST(OutputFile, IsRemovedFromDescriptorZero) {
    const test::TemporaryFolder folder;
    const NoStandardInput closed;
    {
        OutputFile file(folder / "a");
        ASSERT_TRUE(is_open(0));
        file.write("new");
        file.publish();
        EXPECT_EQ(text_of(folder / "a"), "new");
    }
    EXPECT_FALSE(is_open(0));
    EXPECT_EQ(folder.files(), 0u);
}

TEST(OutputFile, WritesIntoAStreamThroughDescriptorZero) {
    const test::TemporaryFolder folder;
    const int descriptor = ::open((folder / "a").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
    ASSERT_GE(descriptor, 0);
    OutputFile stream("/dev/fd/" + std::to_string(descriptor));
    stream.write("new");
    {
        const NoStandardInput closed;
        EXPECT_NO_THROW(stream.commit());
        EXPECT_FALSE(is_open(0));
    }
    ::close(descriptor);
    EXPECT_EQ(text_of(folder / "a"), "new");
}

TEST(OutputFile, RemovesLeftoversOfKilledProcessesOnly) {
    const test::TemporaryFolder folder;
    const std::string begin = ".prtkit-af63dc4c8601ec8c-"; // Fowler-Noll-Vo hash of "a"
    folder.file(begin + "1-1", "left");
    folder.file(begin + "1-2", "another still writes");
    folder.file(".prtkit-af63df4c8601f1a5-1-1", "of b");
    const int other = ::open((folder / (begin + "1-2")).c_str(), O_RDONLY);
    ASSERT_EQ(::flock(other, LOCK_EX), 0);
    OutputFile file(folder / "a");
    file.write("new");
    file.commit();
    ::close(other);
    EXPECT_FALSE(std::filesystem::exists(folder / (begin + "1-1")));
    EXPECT_EQ(folder.files(), 3u);
}

} // namespace
} // namespace prt

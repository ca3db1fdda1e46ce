#include "prt/support/file.h"

#include "prt/support/error.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

namespace prt {
namespace {

std::string text_of(const std::filesystem::path& path) {
    const auto bytes = read_file(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(ReadFile, NamesWhatIsWrong) {
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

TEST(OutputFile, RefusesWhatIsNoRegularFile) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(OutputFile(folder.path()), Error);
    EXPECT_THROW(OutputFile("/dev/null"), Error);
    EXPECT_THROW(OutputFile(folder / "no/such/folder"), Error);
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

} // namespace
} // namespace prt

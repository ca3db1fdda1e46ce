// Tests the removal of control characters.

#include "runtime/core/support/printable.h"

#include <gtest/gtest.h>

namespace prt {
namespace {

TEST(Printable, LeavesTextOfAnyLanguage) {
    for (const char* text : {"", "a b~", "Gr\u00fc\u00dfe", "\u6a39", "\U0001f333"})
        EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesTerminalControlCharacters) {
    EXPECT_EQ(printable("\x1b[31m"), "\\x1b[31m");
    EXPECT_EQ(printable(std::string_view("a\0\r\n\a\x7f", 6)), "a\\x00\\x0d\\x0a\\x07\\x7f");
    EXPECT_EQ(printable("\u009b2J"), "\\u009b2J");
    EXPECT_EQ(printable("\u202egnp.exe\u200b"), "\\u202egnp.exe\\u200b");
    EXPECT_EQ(printable("a\u061cb\u00ad"), "a\\u061cb\\u00ad");
    EXPECT_EQ(printable("\U000e0041"), "\\u0e0041");
}

TEST(Printable, EscapesInvalidUtf8) {
    EXPECT_EQ(printable("\x9b"), "\\x9b");                   // no first byte
    EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");          // cut
    EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b");          // longer than it must be
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80"); // half of a pair
    EXPECT_EQ(printable("\xff"
                        "b"),
              "\\xffb");
}

TEST(Printable, ShortensLongText) {
    const std::string text = printable(std::string(100'000, 'x'));
    EXPECT_LT(text.size(), 1010u);
    EXPECT_TRUE(text.ends_with(" ..."));
}

} // namespace
} // namespace prt

// Tests the help of all commands: every option is listed, in one line of at most 100 characters.

#include "program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace prt::test {
namespace {

const std::vector<std::string> kCommands = {"ao",    "bake", "bench",   "compress", "evaluate", "info",
                                            "lobes", "make", "project", "relight",  "render",   "shader"};

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

std::vector<std::string> help(const std::string& command, const std::string& option = "--help-all") {
    const Outcome outcome = prt({command, option});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return lines_of(outcome.out);
}

/// Returns "--name" of the line of an option; empty for all other lines.
std::string option_of(const std::string& line) {
    const std::size_t dashes = line.find("--");
    if (!line.starts_with("  -") || dashes > 6)
        return {};
    return line.substr(dashes, line.find(' ', dashes) - dashes);
}

/// Returns the parts of `text` between the separators.
std::vector<std::string> split(const std::string& text, char separator) {
    std::istringstream stream(text);
    std::vector<std::string> parts;
    for (std::string part; std::getline(stream, part, separator);)
        parts.push_back(part);
    return parts;
}

TEST(Help, HasOneShortLinePerOption) {
    for (const std::string& command : kCommands)
        for (const std::string& line : help(command)) {
            const auto characters = std::ranges::count_if(
                line, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
            EXPECT_LE(characters, 100) << command << ": " << line;
        }
}

TEST(Help, ListsEveryOption) {
    std::set<std::string> all;
    for (const std::string& command : kCommands) {
        std::set<std::string> listed;
        for (const std::string& line : help(command))
            listed.insert(option_of(line));
        const std::string error = prt({command, "--no-such-option"}).err;
        const std::size_t names = error.find("available: ");
        ASSERT_NE(names, std::string::npos) << error;
        for (const std::string& word : split(error.substr(names + 11), ' ')) {
            const std::string name = word.substr(0, word.find_first_of(",\n"));
            EXPECT_TRUE(listed.contains(name)) << command << " " << name;
            all.insert(name);
        }
    }
    EXPECT_LE(all.size(), 85u);
}

TEST(Help, ShowsOnlyCommonOptionsByDefault) {
    const auto count = [](const std::vector<std::string>& lines) {
        return std::ranges::count_if(lines, [](const std::string& line) { return !option_of(line).empty(); });
    };
    EXPECT_LE(count(help("bake", "--help")), 25);
    EXPECT_GT(count(help("bake")), count(help("bake", "--help")));
}

TEST(Help, ExplainsChoicesInTheirOrder) {
    for (const std::string& command : kCommands) {
        const std::vector<std::string> lines = help(command);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const std::string name = option_of(lines[i]);
            const std::size_t value = lines[i].find(name) + name.size() + 1;
            if (name.empty() || value >= lines[i].size())
                continue;
            std::size_t from = i + 1;
            const std::string values = lines[i].substr(value, lines[i].find_first_of(" [", value) - value);
            if (values.find('|') == std::string::npos ||
                values.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-|") != std::string::npos)
                continue;
            for (const std::string& choice : split(values, '|')) {
                const auto found = std::find_if(lines.begin() + static_cast<std::ptrdiff_t>(from),
                                                lines.end(), [&](const std::string& line) {
                                                    return line.starts_with("        " + choice + ": ") ||
                                                           !option_of(line).empty();
                                                });
                ASSERT_NE(found, lines.end()) << command << " " << name << " " << choice;
                EXPECT_TRUE(option_of(*found).empty()) << command << " " << name << ": " << choice;
                from = static_cast<std::size_t>(std::distance(lines.begin(), found));
                if (!option_of(*found).empty())
                    break;
            }
        }
    }
}

TEST(Help, GivesTheNewNamesOfOldOptions) {
    const auto error = [](const std::vector<std::string>& arguments) {
        const Outcome outcome = prt(arguments);
        EXPECT_EQ(outcome.status, 2);
        return outcome.err;
    };
    EXPECT_NE(error({"bake", "a.glb", "--size", "64"}).find("--size is now --texels N"), std::string::npos);
    EXPECT_NE(error({"ao", "a.glb", "--volume"}).find("--volume is now --occluders"), std::string::npos);
    EXPECT_NE(error({"render", "a.glb", "--env", "a.hdr"}).find("--env is now --lights"), std::string::npos);
    EXPECT_EQ(error({"render", "a.glb", "--size", "1x"}).find("is now"), std::string::npos);
}

} // namespace
} // namespace prt::test

#pragma once

// Help texts: options in groups, one line each.

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace prt::cli {

/// Formats help. Options are listed in groups; rare options and the details of an option (all lines of its
/// description after the first) are shown by --help-all only.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
    std::string make_expanded(const CLI::App* command) const override;
};

/// A group of options in help, with names without "--".
struct HelpGroup {
    std::string_view title;
    std::vector<std::string_view> common, rare;
};
/// Returns all groups, in the order of help. An option has the same meaning in all commands.
const std::vector<HelpGroup>& help_groups();

} // namespace prt::cli

#pragma once

#include <CLI/CLI.hpp>

#include <span>

namespace prt::cli {

/// Refuses the first command or long option of `words` that there is not, and names the one that was meant.
/// CLI11 would name the values after it, too. Throws `CLI::ParseError`.
void check_names(const CLI::App& app, std::span<char* const> words);

} // namespace prt::cli

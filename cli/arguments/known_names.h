#pragma once

#include <CLI/CLI.hpp>

#include <span>

namespace prt::cli {

/// Rejects the first unknown command or long option of `words`, and suggests the nearest name. CLI11 would
/// also report the values after it. Throws `CLI::ParseError`.
void check_names(const CLI::App& app, std::span<char* const> words);

} // namespace prt::cli

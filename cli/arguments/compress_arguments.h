#pragma once

// Options of `prt compress`.

#include "cli/pipeline/compress_model.h"
#include "cli/program/session.h"

#include <CLI/CLI.hpp>

namespace prt::cli {

struct CompressArguments : CompressRequest {
    Path json;
};

/// Adds all options except --output.
void add_options(CLI::App* command, CompressArguments& arguments);

/// Resolves combinations of options: u32 if no size is given, a search if a budget is given.
void resolve(const CLI::App& command, CompressArguments& arguments);

} // namespace prt::cli

#pragma once

// Options of `prt compress`.

#include "cli/pipeline/compress_metric.h"
#include "cli/program/session.h"
#include "prt/compress/search.h"

#include <CLI/CLI.hpp>

#include <optional>

namespace prt::cli {

struct CompressArguments {
    Path baked, output;
    struct Reports {
        Path json, trace;
    } reports;
    SearchOptions options; ///< without a budget only `options.compress` is used
    MetricArguments metric;
    bool components_given = false, predictors_given = false;
    bool preset = false; ///< `options.compress` is a preset, which is fitted to the mesh
    bool best_effort = false;
    struct Writing {
        bool meshopt = false, reorder = false, whole = false;
        Path fallback; ///< a light
    } writing;
    std::optional<int> volume_bytes; ///< bytes of a probe's weights; unset: 16
    ReadingOptions reading;
};

/// Adds all options except --output.
void add_options(CLI::App* command, CompressArguments& arguments);

/// Resolves combinations of options: u32 if no size is given, a search if a budget is given.
void resolve(const CLI::App& command, CompressArguments& arguments);

} // namespace prt::cli

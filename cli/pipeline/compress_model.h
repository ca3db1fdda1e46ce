#pragma once

// Compresses the transfer of a file: what `prt compress` does.

#include "cli/pipeline/compress_metric.h"
#include "cli/pipeline/host.h"
#include "cli/pipeline/model.h"
#include "cli/pipeline/reading_options.h"
#include "cli/report/report.h"
#include "prt/compress/search.h"

#include <optional>

namespace prt::pipeline {

struct CompressRequest {
    FileSource baked;
    Path output;           ///< is passed to Host::write
    Path trace;            ///< gets the events of the compressor; empty: none are recorded
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

/// Compresses the transfer of `request.baked`, and passes the .glb file to `host.write`. Returns the figures.
/// Throws `Error`.
Report compress_model(CompressRequest request, const Host& host);

} // namespace prt::pipeline

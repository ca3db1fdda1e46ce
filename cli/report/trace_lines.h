#pragma once

#include "cli/report/report.h"
#include "prt/compress/compress.h"

#include <string>

namespace prt::pipeline {

/// An event of the compressor as a line of JSON.
std::string trace_line(const CompressEvent& event);

/// The figures of a trial.
Json trial_json(const SearchTrial& trial);

} // namespace prt::pipeline

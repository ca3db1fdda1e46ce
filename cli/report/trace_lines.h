#pragma once

#include "prt/compress_trace.h"

#include <string>

namespace prt::cli {

/// An event of the compressor as a line of JSON.
std::string trace_line(const CompressEvent& event);

} // namespace prt::cli

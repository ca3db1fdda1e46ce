#pragma once

#include "prt/clustered_bases.h"
#include "prt/gltf.h"
#include "report/report.h"
#include "session.h"

namespace prt::cli {

/// Prints a report and writes its figures to `json`. An empty path: nothing is written.
void publish(const Report& report, const Path& json, Session& session);

/// Where a report of figures is to go besides the terminal; empty: nowhere.
struct ReportFiles {
    Path json, html, csv;
};

/// Prints a report and writes it to `files`, which also say by which version it was made; the page says when.
void publish(const Report& report, const ReportFiles& files, Session& session);

/// The parts of a transfer vector: [{"kind": "direct", "channels": 1}, ...], and "1 channel of direct light,
/// 3 of indirect".
Json parts_figures(const TransferLayout& layout);
std::string parts_in_words(const TransferLayout& layout);

/// What the guides of clusters are called.
std::vector<std::string> guide_names(const ClusteredBases& bases);

/// How a bake was made.
Json bake_record_json(const BakeRecord& record);

} // namespace prt::cli

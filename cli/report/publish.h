#pragma once

#include "prt/clustered_bases.h"
#include "prt/gltf.h"
#include "report/report.h"
#include "session.h"

namespace prt::cli {

/// Prints a report and writes its figures to `json`. No file is written if the path is empty.
void publish(const Report& report, const Path& json, Session& session);

/// Files for the figures of a report; empty: not written.
struct ReportFiles {
    Path json, html, csv;
};

/// Prints a report and writes it to `files`, with the program version; the page also contains the date.
void publish(const Report& report, const ReportFiles& files, Session& session);

/// The terms of a transfer vector: [{"kind": "direct", "channels": 1}, ...], and "1 channel of direct light,
/// 3 of indirect".
Json terms_figures(const TransferLayout& layout);
std::string terms_in_words(const TransferLayout& layout);

/// Returns the names of the predictors of clusters.
std::vector<std::string> predictor_names(const ClusteredBases& bases);

/// How a bake was made.
Json bake_record_json(const BakeRecord& record);

} // namespace prt::cli

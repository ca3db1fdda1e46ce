#pragma once

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

/// How a bake was made.
Json bake_record_json(const BakeRecord& record);

} // namespace prt::cli

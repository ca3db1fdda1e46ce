#pragma once

#include "cli/program/session.h"
#include "cli/report/report.h"

namespace prt::cli {

/// Prints a report and writes its figures to `json`. No file is written if the path is empty.
void publish(const Report& report, const Path& json, Session& session);

/// Files for the figures of a report; empty: not written.
struct ReportFiles {
    Path json, html, csv;
};

/// Prints a report and writes it to `files`, with the program version; the page also contains the date.
void publish(const Report& report, const ReportFiles& files, Session& session);

} // namespace prt::cli

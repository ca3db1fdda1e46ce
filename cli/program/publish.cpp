// Prints reports and writes their files.

#include "cli/program/publish.h"

#include "cli/program/session.h"
#include "cli/program/terminal.h"
#include "runtime/core/support/counted.h"

#include <fmt/chrono.h>

#include <chrono>
#include <string>
#include <vector>

namespace prt::cli {

void publish(const Report& report, const Path& json, Session& session) {
    print(report_text(report));
    session.write(json, json_text(report_json(report)));
}

void publish(const Report& report, const ReportFiles& files, Session& session) {
    print(report_text(report));
    Json json = report_json(report);
    json["version"] = PRTKIT_VERSION;
    session.write(files.json, json_text(json));
    session.write(files.csv, report_csv(report));
    if (files.html.empty())
        return;
    Report dated = report; // only the page has a date, so that files of figures do not change from run to run
    const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    dated.origin.emplace_back("date", fmt::format("{:%Y-%m-%d %H:%M} UTC", now));
    dated.origin.emplace_back("version", "prt " PRTKIT_VERSION);
    session.write(files.html, report_html(dated));
}

} // namespace prt::cli

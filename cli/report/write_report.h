#pragma once

#include "prt/gltf.h"
#include "prt/light.h"
#include "session.h"

#include "report/report.h"

#include <filesystem>

namespace prt::cli {

/// Writes a report, all or nothing. An empty path: nothing is written.
void write_json(const Json& json, const std::filesystem::path& path, Interrupt& interrupt);

/// Writes text, all or nothing. An empty path: nothing is written.
void write_text(const std::string& text, const std::filesystem::path& path, Interrupt& interrupt);

/// Where a report is to go besides the terminal; empty: nowhere.
struct ReportFiles {
    std::filesystem::path json, html, csv;
};

/// Prints a report and writes it to `files`. The page also says when it was made and by which version.
void publish(const Report& report, const ReportFiles& files, Interrupt& interrupt);

/// How a bake was made.
Json bake_record_json(const BakeRecord& record);

} // namespace prt::cli

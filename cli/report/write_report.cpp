#include "report/write_report.h"

#include "prt/support/file.h"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <chrono>
#include <string>

namespace prt::cli {

void write_json(const Json& json, const std::filesystem::path& path, Interrupt& interrupt) {
    write_text(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", path, interrupt);
}

void write_text(const std::string& text, const std::filesystem::path& path, Interrupt& interrupt) {
    if (path.empty())
        return;
    const Interrupt::WritingScope writing(interrupt);
    OutputFile file(path);
    file.write(text);
    file.commit();
}

void publish(const Report& report, const ReportFiles& files, Interrupt& interrupt) {
    fmt::print("{}", report_text(report));
    Json json = report_json(report);
    json["version"] = PRTKIT_VERSION;
    write_json(json, files.json, interrupt);
    write_text(report_csv(report), files.csv, interrupt);
    if (files.html.empty())
        return;
    Report dated = report; // files of figures stay the same from run to run
    const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    dated.origin.emplace_back("date", fmt::format("{:%Y-%m-%d %H:%M} UTC", now));
    dated.origin.emplace_back("version", "prt " PRTKIT_VERSION);
    write_text(report_html(dated), files.html, interrupt);
}

Json bake_record_json(const BakeRecord& record) {
    return {{"method", to_string(record.method)},
            {"backend", to_string(record.backend)},
            {"rays_per_receiver", record.rays},
            {"bounces", record.bounces},
            {"seed", record.seed},
            {"receivers_id", record.receivers},
            {"sampling_error_relative_l2", record.sampling_error}};
}

} // namespace prt::cli

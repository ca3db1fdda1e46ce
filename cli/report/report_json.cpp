// Writes reports as JSON and CSV.

#include "report/report.h"

#include <algorithm>
#include <utility>

namespace prt::cli {
namespace {

/// Returns a cell quoted by RFC 4180.
std::string csv_cell(const Json& value) {
    std::string text = value.is_string() ? value.get<std::string>() : value.is_null() ? "" : value.dump();
    if (text.find_first_of(",\"\n\r") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (const char c : text)
        quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

} // namespace

// Not in nested braces: GCC 12 destroys the column twice where memory ends in the value.
void add_figure(Report& report, Column column, Json value) {
    Figure figure{.column = std::move(column), .value = std::move(value)};
    report.figures.push_back(std::move(figure));
}

void add_figures(Report& report, const Json& object) {
    for (const auto& [key, value] : object.items())
        add_figure(report, {key}, value);
}

std::string json_text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json report_json(const Report& report) {
    Json json = Json::object();
    if (!report.verdict.empty())
        json["verdict"] = report.verdict;
    for (const auto& [name, value] : report.origin)
        json[name] = value;
    for (const Figure& figure : report.figures)
        json[figure.column.key] = figure.value;
    for (const Table& table : report.tables) {
        if (table.audience == Audience::people)
            continue;
        Json& rows = json[Json::json_pointer("/" + table.key)] = Json::array();
        for (const auto& row : table.rows) {
            Json object = Json::object();
            for (std::size_t c = 0; c < row.size(); ++c)
                object[table.columns[c].key] = row[c];
            rows.push_back(std::move(object));
        }
    }
    if (!report.notes.empty())
        json["left_out"] = report.notes;
    if (!report.notices.empty())
        json["notices"] = report.notices;
    return json;
}

std::string report_csv(const Report& report) {
    std::string csv = "table,row,figure,value\n";
    const auto line = [&](const std::string& table, const Json& row, const std::string& key,
                          const Json& value) {
        csv += csv_cell(table) + "," + csv_cell(row) + "," + csv_cell(key) + "," + csv_cell(value) + "\n";
    };
    for (const auto& [name, value] : report.origin)
        line("", "", name, value);
    for (const Figure& figure : report.figures)
        line("", "", figure.column.key, figure.value);
    for (const Table& table : report.tables) {
        if (table.audience == Audience::people)
            continue;
        for (const auto& row : table.rows)
            for (std::size_t c = 1; c < row.size(); ++c)
                line(table.key, row.front(), table.columns[c].key, row[c]);
    }
    return csv;
}

} // namespace prt::cli

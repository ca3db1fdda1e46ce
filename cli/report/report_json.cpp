// Writes reports as JSON and CSV.

#include "cli/report/report.h"

#include <algorithm>
#include <utility>

namespace prt::pipeline {
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

/// The key and, in brackets, the unit: 1 for shares of one.
std::string csv_name(const Column& column) {
    const auto names = [&](const char* word) { return column.key.find(word) != std::string::npos; };
    if (column.unit == Unit::seconds || (names("seconds") && !names("per_second")))
        return column.key + " [s]";
    if (names("bytes"))
        return column.key + " [B]";
    return column.unit == Unit::percent ? column.key + " [1]" : column.key;
}

/// Rows of any tables under one header: the first cell of a row is the key of its table.
class CsvRows {
public:
    void add(const std::string& table, const std::vector<Column>& columns, const std::vector<Json>& values) {
        std::vector<std::string> row(1, csv_cell(table));
        for (std::size_t c = 0; c < values.size(); ++c) {
            if (values[c].is_structured())
                continue; // JSON alone has lists
            const std::size_t at = column_of(csv_name(columns[c]));
            row.resize(std::max(row.size(), at + 1));
            row[at] = csv_cell(values[c]);
        }
        rows_.push_back(std::move(row));
    }
    std::string text() {
        rows_.insert(rows_.begin(), header_);
        std::string csv;
        for (std::vector<std::string>& row : rows_) {
            row.resize(header_.size());
            for (std::size_t c = 0; c < row.size(); ++c)
                csv += (c == 0 ? "" : ",") + row[c];
            csv += "\n";
        }
        return csv;
    }

private:
    std::size_t column_of(const std::string& name) {
        const std::string cell = csv_cell(name);
        const auto found = std::find(header_.begin(), header_.end(), cell);
        const auto at = static_cast<std::size_t>(found - header_.begin());
        if (found == header_.end())
            header_.push_back(cell);
        return at;
    }
    std::vector<std::string> header_ = {"table"};
    std::vector<std::vector<std::string>> rows_;
};

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
        json["omitted"] = report.notes;
    if (!report.notices.empty())
        json["notices"] = report.notices;
    return json;
}

std::string report_csv(const Report& report) {
    CsvRows csv;
    for (const Table& table : report.tables)
        if (table.audience != Audience::people)
            for (const std::vector<Json>& row : table.rows)
                csv.add(table.key, table.columns, row);
    std::vector<Column> columns;
    std::vector<Json> values;
    for (const auto& [name, value] : report.origin) {
        columns.push_back({name});
        values.emplace_back(value);
    }
    for (const Figure& figure : report.figures) {
        columns.push_back(figure.column);
        values.push_back(figure.value);
    }
    csv.add("summary", columns, values);
    return csv.text();
}

} // namespace prt::pipeline

#pragma once

// A report is one list of figures. Text, JSON, CSV and HTML show the same list, so that no figure is written
// twice.

#include <nlohmann/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace prt::pipeline {

using Json = nlohmann::ordered_json;

/// Format of a value for people. JSON and CSV contain the value itself, with the unit in its key.
enum class Unit {
    plain,   ///< unchanged
    percent, ///< value as a fraction of 1
    seconds,
};

struct Column {
    std::string key;        ///< in JSON and CSV
    std::string title = {}; ///< for people; empty: only in JSON and CSV
    Unit unit = Unit::plain;
    int digits = 3; ///< digits after the decimal point, for people
};

struct Figure {
    Column column;
    Json value;
};

struct ChartPoint {
    double x = 0, y = 0; ///< points that are not above zero are omitted
    std::string label;   ///< shown when pointed at
};

struct ChartSeries {
    std::string name;
    std::vector<ChartPoint> points; ///< in the order of the curve
    bool strong = false;            ///< a thicker line
};

/// Curves over logarithmic axes.
struct Chart {
    std::string x_title, y_title;
    std::vector<ChartSeries> series;
};

/// A bar of consecutive parts.
struct Bar {
    std::string name, value;     ///< at its beginning and at its end
    std::vector<double> lengths; ///< [series]
};

/// Bars below each other, on one scale.
struct Bars {
    std::string title;
    std::vector<std::string> series;
    std::vector<Bar> bars;
};

/// Readers of a table.
enum class Audience { all, files, people };

struct Table {
    std::string key;          ///< in JSON, with '/' between levels
    std::string title, about; ///< about: a sentence that explains the columns
    std::vector<Column> columns;
    std::vector<std::vector<Json>> rows; ///< [rows][columns]; null: no value
    std::vector<Chart> charts = {};      ///< before the table, for HTML
    std::vector<Bars> bars = {};         ///< before the table, for HTML
    Audience audience = Audience::all;
    std::size_t max_shown = 1000; ///< maximum number of rows shown to people
};

struct ReportPicture {
    std::string title;
    std::vector<std::byte> png;
};

struct Report {
    std::string title;
    std::string verdict;                                     ///< one line; empty: no verdict
    std::vector<std::pair<std::string, std::string>> origin; ///< files and command that the figures belong to
    std::vector<Figure> figures;
    std::vector<Table> tables;
    std::vector<ReportPicture> pictures; ///< for HTML
    std::vector<std::string> notes;      ///< missing results and their reasons
    /// notices about reading the scene; for JSON, because they are printed earlier
    std::vector<std::string> notices;
    /// Lines of text shown on the terminal instead of all members above. "{key}" and "{key:format}" are
    /// figures of the JSON; '/' accesses members of lists and objects. A format is one of fmt's; a following
    /// '%' or 'M' means per cent or millions. "{key:#sun}" is a number with its noun, "1 sun" or "2 suns";
    /// "{key:#vertex|vertices}" has an irregular plural.
    std::vector<std::string> sentences;
};

void add_figure(Report& report, Column column, Json value);

/// Adds the items of an object as figures.
void add_figures(Report& report, const Json& object);

/// Returns a value in the format for people, "-" for null.
std::string shown(const Json& value, const Column& column);
/// Return the indices of the columns, and the number of rows, that people see.
std::vector<std::size_t> columns_for_people(const Table& table);
std::size_t rows_for_people(const Table& table);

/// Returns the text for the terminal.
std::string report_text(const Report& report);
/// Returns all figures by key, tables as lists of objects.
Json report_json(const Report& report);
std::string json_text(const Json& json);
/// Returns a line for each row of each table, with the table in the first column; the last line, "summary",
/// has the figures. The header lists the keys of all tables, with units in brackets. Only JSON has lists.
std::string report_csv(const Report& report);
/// Returns a self-contained page: report/page.html with the report as JSON. It loads no other file.
std::string report_html(const Report& report);

} // namespace prt::pipeline

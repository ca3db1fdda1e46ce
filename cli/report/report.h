#pragma once

// A report is one list of figures. Text, JSON, CSV and HTML each show the same list in their way, so that no
// figure is written down twice.

#include <nlohmann/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace prt::cli {

using Json = nlohmann::ordered_json;

/// How people read a value. JSON and CSV hold the value itself, with the unit in its key.
enum class Unit {
    plain,   ///< as it is
    percent, ///< a share of 1
    seconds,
};

struct Column {
    std::string key;        ///< in JSON and CSV
    std::string title = {}; ///< for people; empty: in JSON and CSV alone
    Unit unit = Unit::plain;
    int digits = 3; ///< behind the point, of what people see
};

struct Figure {
    Column column;
    Json value;
};

struct ChartPoint {
    double x = 0, y = 0; ///< points that are not above zero are left out
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

/// A bar of parts one behind the other.
struct Bar {
    std::string name, value;     ///< at its beginning and at its end
    std::vector<double> lengths; ///< [series]
};

/// Bars under one another, on one scale.
struct Bars {
    std::string title;
    std::vector<std::string> series;
    std::vector<Bar> bars;
};

/// Who a table is for.
enum class Audience { all, files, people };

struct Table {
    std::string key;          ///< in JSON, with '/' between levels
    std::string title, about; ///< about: a sentence on what the columns are
    std::vector<Column> columns;
    std::vector<std::vector<Json>> rows; ///< [rows][columns]; null: there is none
    std::vector<Chart> charts = {};      ///< before the table, for HTML
    std::vector<Bars> bars = {};         ///< the same
    Audience audience = Audience::all;
    std::size_t most_shown = 1000; ///< rows that people see
};

struct ReportPicture {
    std::string title;
    std::vector<std::byte> png;
};

struct Report {
    std::string title;
    std::string verdict;                                     ///< one line; empty: there is none
    std::vector<std::pair<std::string, std::string>> origin; ///< files, command: what the figures are of
    std::vector<Figure> figures;
    std::vector<Table> tables;
    std::vector<ReportPicture> pictures; ///< for HTML
    std::vector<std::string> notes;      ///< what is missing, and why
    std::vector<std::string> notices;    ///< of how the scene was read; for JSON, as they are printed before
    /// Lines of text that stand for all of the above on the terminal. "{key}" and "{key:format}" are figures
    /// of the JSON, where '/' leads into lists and objects; a format is one of fmt's, and a '%' or 'M' behind
    /// it means per cent or millions.
    std::vector<std::string> sentences;
};

void add_figure(Report& report, Column column, Json value);

/// Adds the items of an object as figures.
void add_figures(Report& report, const Json& object);

/// A value as people read it, "-" where there is none.
std::string shown(const Json& value, const Column& column);
/// The columns, as numbers, and rows that people see.
std::vector<std::size_t> columns_for_people(const Table& table);
std::size_t rows_for_people(const Table& table);

/// Lines for the terminal.
std::string report_text(const Report& report);
/// All figures by key, tables as lists of objects.
Json report_json(const Report& report);
std::string json_text(const Json& json);
/// A line for each row of each table, named in the first column; the last line, "summary", has the figures.
/// The header names the keys of all tables, with units in brackets. Lists are in JSON alone.
std::string report_csv(const Report& report);
/// A page that stands alone: report/page.html with the report as JSON in it. Nothing is loaded.
std::string report_html(const Report& report);

} // namespace prt::cli

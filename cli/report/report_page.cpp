// Writes reports as HTML.

#include "cli/report/report.h"
#include "cli/report/report_files.h"

#include <string_view>

namespace prt::pipeline {
namespace {

std::string base64(const std::vector<std::byte>& bytes) {
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t b = 0; b < 3; ++b)
            group = group << 8 | (i + b < bytes.size() ? std::to_integer<unsigned>(bytes[i + b]) : 0u);
        for (std::size_t d = 0; d < 4; ++d)
            text += i + d > bytes.size() ? '=' : kDigits[group >> (18 - 6 * d) & 63];
    }
    return text;
}

Json chart_json(const Chart& chart) {
    Json series = Json::array();
    for (const ChartSeries& s : chart.series) {
        Json points = Json::array();
        for (const ChartPoint& point : s.points)
            points.push_back({{"x", point.x}, {"y", point.y}, {"label", point.label}});
        series.push_back({{"name", s.name}, {"strong", s.strong}, {"points", points}});
    }
    return {{"x_title", chart.x_title}, {"y_title", chart.y_title}, {"series", series}};
}

Json bars_json(const Bars& bars) {
    Json list = Json::array();
    for (const Bar& bar : bars.bars)
        list.push_back({{"name", bar.name}, {"value", bar.value}, {"lengths", bar.lengths}});
    return {{"title", bars.title}, {"series", bars.series}, {"bars", list}};
}

/// Cells as text, the head first.
Json table_json(const Table& table) {
    const std::vector<std::size_t> columns = columns_for_people(table);
    Json rows = Json::array({Json::array()});
    for (const std::size_t c : columns)
        rows[0].push_back(table.columns[c].title);
    for (std::size_t r = 0; r < rows_for_people(table); ++r) {
        rows.push_back(Json::array());
        for (const std::size_t c : columns)
            rows.back().push_back(shown(table.rows[r][c], table.columns[c]));
    }
    Json charts = Json::array(), bars = Json::array();
    for (const Bars& one : table.bars)
        bars.push_back(bars_json(one));
    for (const Chart& chart : table.charts)
        charts.push_back(chart_json(chart));
    return {
        {"title", table.title}, {"about", table.about}, {"rows", rows}, {"charts", charts}, {"bars", bars}};
}

/// Returns the visible content of a report, for report/page.js.
Json page_json(const Report& report) {
    Json page = {{"title", report.title}, {"verdict", report.verdict}, {"notes", report.notes}};
    for (const char* list : {"origin", "figures", "tables", "pictures"})
        page[list] = Json::array();
    for (const auto& [name, value] : report.origin)
        page["origin"].push_back(Json::array({name, value}));
    for (const Figure& figure : report.figures)
        if (!figure.column.title.empty())
            page["figures"].push_back(Json::array({figure.column.title, shown(figure.value, figure.column)}));
    for (const Table& table : report.tables)
        if (rows_for_people(table) > 0)
            page["tables"].push_back(table_json(table));
    for (const ReportPicture& picture : report.pictures)
        page["pictures"].push_back({{"title", picture.title}, {"png", base64(picture.png)}});
    return page;
}

void put(std::string_view mark, const std::string& text, std::string& page) {
    page.replace(page.find(mark), mark.size(), text);
}

} // namespace

std::string report_html(const Report& report) {
    std::string json;
    for (const char c : page_json(report).dump(-1, ' ', false, Json::error_handler_t::replace))
        json += c == '<' ? "\\u003c" : std::string(1, c); // which could end the script
    std::string page = report_files().at("page.html");
    put("{{script}}", report_files().at("page.js"), page);
    put("{{report}}", json, page);
    return page;
}

} // namespace prt::pipeline

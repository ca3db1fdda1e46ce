#include "report/html.h"
#include "report/report.h"
#include "report/report_page.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::cli {
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

std::string origin_html(const Report& report) {
    std::string html = "<dl>\n";
    for (const auto& [name, value] : report.origin)
        html += fmt::format("<dt>{}</dt><dd><code>{}</code></dd>\n", html_escaped(name), html_escaped(value));
    return html + "</dl>";
}

std::string figures_html(const Report& report) {
    std::string html;
    for (const Figure& figure : report.figures)
        if (!figure.column.detail)
            html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", html_escaped(figure.column.title),
                                html_escaped(shown(figure.value, figure.column)));
    return html.empty() ? html
                        : "<h2>Figures</h2>\n<div class=\"scroll\"><table>\n" + html + "</table></div>";
}

std::string row_html(const std::vector<std::string>& cells, const char* tag) {
    std::string html = "<tr>";
    for (const std::string& cell : cells)
        html += fmt::format("<{0}>{1}</{0}>", tag, html_escaped(cell));
    return html + "</tr>\n";
}

std::string table_html(const Table& table) {
    std::string html = fmt::format("<h2>{}</h2>\n", html_escaped(table.title)) + table.chart;
    std::vector<std::string> cells;
    for (const Column& column : table.columns)
        if (!column.detail)
            cells.push_back(column.title);
    html += "<div class=\"scroll\"><table>\n" + row_html(cells, "th");
    for (std::size_t r = 0; r < std::min(table.most_shown, table.rows.size()); ++r) {
        cells.clear();
        for (std::size_t c = 0; c < table.columns.size(); ++c)
            if (!table.columns[c].detail)
                cells.push_back(shown(table.rows[r][c], table.columns[c]));
        html += row_html(cells, "td");
    }
    html += "</table></div>\n";
    return table.about.empty() ? html : html + fmt::format("<p>{}</p>\n", html_escaped(table.about));
}

std::string pictures_html(const Report& report) {
    if (report.pictures.empty())
        return {};
    std::string html = "<div class=\"pictures\">\n";
    for (const ReportPicture& picture : report.pictures)
        html += fmt::format("<figure><img alt=\"{0}\" "
                            "src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
                            html_escaped(picture.title), base64(picture.png));
    return html + "</div>";
}

} // namespace

std::string report_html(const Report& report) {
    std::string tables, notes;
    for (const Table& table : report.tables)
        if (table.audience != Audience::files && !table.rows.empty())
            tables += table_html(table);
    for (const std::string& note : report.notes)
        notes += fmt::format("<p>Left out: {}.</p>\n", html_escaped(note));
    const std::string verdict =
        report.verdict.empty() ? ""
                               : fmt::format("<p class=\"verdict\">{}</p>", html_escaped(report.verdict));
    return filled_page({{"title", html_escaped(report.title)},
                        {"verdict", verdict},
                        {"origin", origin_html(report)},
                        {"pictures", pictures_html(report)},
                        {"figures", figures_html(report)},
                        {"tables", tables},
                        {"notes", notes}});
}

} // namespace prt::cli

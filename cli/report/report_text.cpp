#include "report/report.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

namespace prt::cli {
namespace {

/// Characters that a string takes on the terminal (UTF-8).
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool left) {
    const std::string space(width > width_of(text) ? width - width_of(text) : 0, ' ');
    return left ? text + space : space + text;
}

/// Lines of at most 100 characters, broken at spaces.
std::string wrapped(const std::string& text, const std::string& indent) {
    constexpr std::size_t kWidth = 100;
    std::string lines, line = indent;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (line != indent && width_of(line) + 1 + width_of(word) > kWidth) {
            lines += line + "\n";
            line = indent;
        }
        line += (line == indent ? "" : " ") + word;
    }
    return lines + line + "\n";
}

/// The first column to the left, numbers to the right, as wide as they need.
std::string table_text(const Table& table) {
    std::vector<std::vector<std::string>> cells(1);
    std::vector<std::size_t> in_sight;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (!table.columns[c].detail) {
            in_sight.push_back(c);
            cells[0].push_back(table.columns[c].title);
        }
    for (std::size_t r = 0; r < std::min(table.most_shown, table.rows.size()); ++r) {
        cells.emplace_back();
        for (const std::size_t c : in_sight)
            cells.back().push_back(shown(table.rows[r][c], table.columns[c]));
    }
    std::string text = "  " + table.title + "\n";
    for (const auto& row : cells) {
        text += "   ";
        for (std::size_t c = 0; c < row.size(); ++c) {
            std::size_t width = 0;
            for (const auto& other : cells)
                width = std::max(width, width_of(other[c]));
            text += " " + padded(row[c], width + (c == 0 ? 0 : 1), c == 0);
        }
        text.erase(text.find_last_not_of(' ') + 1);
        text += "\n";
    }
    return table.about.empty() ? text : text + wrapped(table.about, "    ");
}

} // namespace

std::string shown(const Json& value, const Column& column) {
    if (value.is_null())
        return "-";
    if (value.is_string())
        return value.get<std::string>();
    if (!value.is_number())
        return value.dump();
    if (value.is_number_integer() && column.unit == Unit::plain)
        return value.dump();
    switch (column.unit) {
    case Unit::percent:
        return fmt::format("{:.{}f} %", 100 * value.get<double>(), column.digits);
    case Unit::seconds:
        return fmt::format("{:.{}f} s", value.get<double>(), column.digits);
    case Unit::plain:
        break;
    }
    return fmt::format("{:.{}g}", value.get<double>(), column.digits + 1);
}

std::string report_text(const Report& report) {
    std::string text = report.verdict.empty() ? report.title + "\n" : report.verdict + "\n";
    for (const auto& [name, value] : report.origin)
        text += fmt::format("  {}: {}\n", name, value);
    for (const Figure& figure : report.figures)
        if (!figure.column.detail)
            text += fmt::format("  {}: {}\n", figure.column.title, shown(figure.value, figure.column));
    for (const Table& table : report.tables)
        if (table.audience != Audience::files && !table.rows.empty())
            text += table_text(table);
    for (const std::string& note : report.notes)
        text += "  left out: " + note + "\n";
    return text;
}

} // namespace prt::cli

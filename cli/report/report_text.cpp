// Writes reports as text for the terminal.

#include "cli/report/report.h"
#include "runtime/core/support/printable.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

namespace prt::pipeline {
namespace {

/// Returns the number of characters of a UTF-8 string.
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
    const std::vector<std::size_t> columns = columns_for_people(table);
    std::vector<std::vector<std::string>> cells(1);
    for (const std::size_t c : columns)
        cells[0].push_back(table.columns[c].title);
    for (std::size_t r = 0; r < rows_for_people(table); ++r) {
        cells.emplace_back();
        for (const std::size_t c : columns)
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

/// Returns a number with its noun. `nouns`: "sun", or "vertex|vertices" if the plural is irregular.
std::string with_noun(std::string number, std::string_view nouns) {
    const std::size_t bar = std::min(nouns.find('|'), nouns.size());
    const bool one = number == "1";
    if (one || bar == nouns.size())
        return number.append(" ").append(nouns.substr(0, bar)).append(one ? "" : "s");
    return number.append(" ").append(nouns.substr(bar + 1));
}

/// A figure in a sentence.
std::string in_words(const Json& value, std::string format) {
    const bool noun = format.starts_with('#');
    if (value.is_string()) {
        std::string text = printable(value.get<std::string>());
        return noun ? with_noun(std::move(text), format.substr(1)) : text;
    }
    if (format.empty())
        return value.dump();
    if (noun)
        return with_noun(value.dump(), format.substr(1));
    const char last = format.back();
    const double scale = last == '%' ? 100 : last == 'M' ? 1e-6 : 1;
    if (scale != 1)
        format.pop_back();
    return fmt::format(fmt::runtime("{:" + format + "}"), scale * value.get<double>()) +
           (last == '%' ? " %" : "");
}

std::string with_figures(const std::string& sentence, const Json& figures) {
    std::string text;
    std::size_t at = 0;
    for (std::size_t open = 0; (open = sentence.find('{', at)) != std::string::npos;) {
        const std::size_t close = sentence.find('}', open);
        const std::string field = sentence.substr(open + 1, close - open - 1);
        const std::size_t colon = std::min(field.find(':'), field.size());
        const Json& value = figures.at(Json::json_pointer("/" + field.substr(0, colon)));
        text +=
            sentence.substr(at, open - at) + in_words(value, field.substr(std::min(colon + 1, field.size())));
        at = close + 1;
    }
    return text + sentence.substr(at);
}

/// Returns the sentences: the first at the left, its details indented below.
std::string sentences_text(const Report& report) {
    const Json figures = report_json(report);
    std::string text;
    for (const std::string& sentence : report.sentences)
        text += (text.empty() ? "" : "  ") + with_figures(sentence, figures) + "\n";
    return text;
}

} // namespace

std::vector<std::size_t> columns_for_people(const Table& table) {
    std::vector<std::size_t> columns;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (!table.columns[c].title.empty())
            columns.push_back(c);
    return columns;
}

std::size_t rows_for_people(const Table& table) {
    return table.audience == Audience::files ? 0 : std::min(table.max_shown, table.rows.size());
}

std::string shown(const Json& value, const Column& column) {
    if (value.is_null())
        return "-";
    if (value.is_string())
        return printable(value.get<std::string>());
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
    if (!report.sentences.empty())
        return sentences_text(report);
    std::string text = report.verdict.empty() ? printable(report.title) + "\n" : report.verdict + "\n";
    for (const auto& [name, value] : report.origin)
        text += fmt::format("  {}: {}\n", name, printable(value));
    for (const Figure& figure : report.figures)
        if (!figure.column.title.empty())
            text += fmt::format("  {}: {}\n", figure.column.title, shown(figure.value, figure.column));
    for (const Table& table : report.tables)
        if (rows_for_people(table) > 0)
            text += table_text(table);
    for (const std::string& note : report.notes)
        text += "  omitted: " + printable(note) + "\n";
    return text;
}

} // namespace prt::pipeline

// Renames vertices to texels in a report.

#include "cli/report/of_texels.h"

#include <string>
#include <string_view>
#include <utility>

namespace prt::pipeline {
namespace {

void replace_all(std::string& text, std::string_view word, std::string_view by) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
        text.replace(at, word.size(), by);
}

std::string of_texels(std::string text) {
    for (const auto& [word, by] :
         {std::pair("per vertex", "per texel"), {"per_vertex", "per_texel"}, {"a vertex", "a texel"}})
        replace_all(text, word, by);
    return text;
}

/// "vertices" as a number, and as a cause of errors.
std::string title_of_texels(std::string title) {
    return title == "vertices" ? "texels" : of_texels(std::move(title));
}

/// Renames keys only.
Json of_texels(const Json& json) {
    if (json.is_array()) {
        Json list = Json::array();
        for (const Json& element : json)
            list.push_back(of_texels(element));
        return list;
    }
    if (!json.is_object())
        return json;
    Json object = Json::object();
    for (const auto& [key, value] : json.items())
        object[of_texels(key)] = of_texels(value);
    return object;
}

} // namespace

void report_texels(Report& report) {
    for (Figure& figure : report.figures) {
        figure.column.key = of_texels(std::move(figure.column.key));
        figure.column.title = title_of_texels(std::move(figure.column.title));
        figure.value = of_texels(figure.value);
    }
    for (Table& table : report.tables)
        for (Column& column : table.columns)
            column.title = title_of_texels(std::move(column.title));
    report.verdict = of_texels(std::move(report.verdict));
    for (std::string& sentence : report.sentences)
        sentence = of_texels(std::move(sentence));
}

} // namespace prt::pipeline

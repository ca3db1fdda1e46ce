// Parses level-of-detail names as used by modelling tools and game engines.
#include "runtime/load/level_names.h"

#include <algorithm>

namespace prt {
namespace {

char small_letter(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool parts_words(char c) {
    return c == '_' || c == '-' || c == '.' || c == ' ';
}

/// Returns the number of digits at the end of `text`.
std::size_t digits_at_end(std::string_view text) {
    std::size_t count = 0;
    while (count < text.size() && is_digit(text[text.size() - 1 - count]))
        ++count;
    return count;
}

std::optional<LevelName> level_of(std::string_view text) {
    constexpr std::string_view kWord = "lod";
    const std::size_t digits = digits_at_end(text);
    if (digits == 0 || digits > 2)
        return std::nullopt;
    const std::string_view number = text.substr(text.size() - digits);
    text.remove_suffix(digits);
    if (!text.empty() && parts_words(text.back()))
        text.remove_suffix(1);
    if (!text.ends_with(kWord))
        return std::nullopt;
    text.remove_suffix(kWord.size());
    if (!text.empty() && !parts_words(text.back()))
        return std::nullopt;
    int level = 0;
    for (const char digit : number)
        level = 10 * level + (digit - '0');
    return LevelName{std::string(text), level};
}

} // namespace

std::optional<LevelName> level_name(std::string_view name) {
    std::string text(name);
    std::ranges::transform(text, text.begin(), small_letter);
    if (std::optional<LevelName> level = level_of(text))
        return level;
    const std::size_t dot = text.size() - digits_at_end(text);
    if (dot == 0 || dot == text.size() || text[dot - 1] != '.')
        return std::nullopt;
    std::optional<LevelName> level = level_of(std::string_view(text).substr(0, dot - 1));
    if (level)
        level->stem += text.substr(dot - 1);
    return level;
}

} // namespace prt

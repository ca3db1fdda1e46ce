// Quotes words for a shell.

#include "cli/pipeline/shell_word.h"

namespace prt::pipeline {

std::string shell_word(std::string_view word) {
    if (!word.empty() && word.find_first_of(" \t\n'\"\\$`*?;&|<>(){}#~![]") == std::string_view::npos)
        return std::string(word);
    std::string text = "'";
    for (const char c : word)
        text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

} // namespace prt::pipeline

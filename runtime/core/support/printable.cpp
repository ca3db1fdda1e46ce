// Escapes characters that affect a terminal.
#include "runtime/core/support/printable.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace prt {
namespace {

/// A UTF-8 character and its length; 0 bytes if the text is not valid UTF-8.
struct Character {
    std::uint32_t code = 0;
    std::size_t bytes = 0;
};

Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const auto ones = static_cast<std::size_t>(std::countl_one(byte(0)));
    if (ones == 0)
        return {byte(0), 1};
    if (ones == 1 || ones > 4 || ones > text.size())
        return {};
    std::uint32_t code = byte(0) & (0x7fu >> ones);
    for (std::size_t i = 1; i < ones; ++i) {
        if (byte(i) >> 6 != 2)
            return {};
        code = code << 6 | (byte(i) & 0x3fu);
    }
    constexpr std::uint32_t kMin[] = {0, 0, 0x80, 0x800, 0x10000}; // minimum code point per number of bytes
    const bool surrogate = code >= 0xd800 && code < 0xe000;
    return code < kMin[ones] || code > 0x10ffff || surrogate ? Character{} : Character{code, ones};
}

/// Returns false for control characters and for characters that change the display of others.
bool is_shown(std::uint32_t code) {
    const auto within = [&](std::uint32_t first, std::uint32_t last) {
        return code >= first && code <= last;
    };
    return code >= 0x20 && !within(0x7f, 0x9f) && !within(0x200b, 0x200f) && !within(0x2028, 0x202e) &&
           !within(0x2060, 0x206f) && code != 0xad && code != 0x61c && code != 0x180e && code != 0xfeff &&
           !within(0xfff9, 0xfffb) && code < 0xe0000;
}

std::string hexadecimal(std::uint32_t value, int digits) {
    std::string text;
    for (int d = digits - 1; d >= 0; --d)
        text += "0123456789abcdef"[value >> (4 * d) & 15u];
    return text;
}

} // namespace

std::string printable(std::string_view text, std::size_t max_bytes) {
    std::string result;
    while (!text.empty()) {
        if (result.size() > max_bytes)
            return result + " ...";
        const Character character = first_character(text);
        const std::size_t bytes = std::max<std::size_t>(character.bytes, 1);
        if (character.bytes == 0)
            result += "\\x" + hexadecimal(static_cast<std::uint8_t>(text[0]), 2);
        else if (is_shown(character.code))
            result += text.substr(0, bytes);
        else if (character.code < 0x80)
            result += "\\x" + hexadecimal(character.code, 2);
        else
            result += "\\u" + hexadecimal(character.code, character.code > 0xffff ? 6 : 4);
        text.remove_prefix(bytes);
    }
    return result;
}

} // namespace prt

// Parses Radiance headers: G. Ward Larson, R. Shakespeare, "Rendering with Radiance", 1998; "Radiance File
// Formats", section on pictures. Lines of text up to an empty one, then the resolution string, for example
// "-Y 512 +X 1024".
#include "runtime/image/radiance_header.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace prt {
namespace {

/// Removes a line from `rest`; empty if the file ends within it.
std::optional<std::string_view> take_line(std::string_view& rest) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos)
        return std::nullopt;
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    if (line.ends_with('\r'))
        line.remove_suffix(1);
    return line;
}

std::string_view take_word(std::string_view& rest) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
    rest.remove_prefix(word.size());
    return word;
}

template <class Number>
std::optional<Number> number_of(std::string_view word) {
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size() ? std::optional(number) : std::nullopt;
}

/// Parses a positive multiplier of pixels.
double multiplier(std::string_view& rest, std::string_view line) {
    std::string_view word = take_word(rest);
    if (word.starts_with('+'))
        word.remove_prefix(1);
    const std::optional<double> value = number_of<double>(word);
    if (!value || !(*value > 0) || !std::isfinite(*value))
        throw Error("is a damaged Radiance HDR: '" + printable(line, 60) +
                    "' does not have a positive number");
    return *value;
}

/// Applies one line of the header.
void read_variable(std::string_view line, RadianceHeader& header) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos)
        return; // the first line, a command or a comment
    const std::string_view name = line.substr(0, equals);
    std::string_view value = line.substr(equals + 1);
    if (name == "EXPOSURE") {
        header.factor *= multiplier(value, line);
    } else if (name == "COLORCORR") {
        for (int c = 0; c < 3; ++c)
            header.factor[c] *= multiplier(value, line);
    } else if (name == "FORMAT") {
        const std::string_view format = take_word(value);
        if (format != "32-bit_rle_rgbe" && format != "32-bit_rle_xyze")
            throw Error("is a damaged or unsupported Radiance HDR: its format is '" + printable(format, 60) +
                        "', not 32-bit_rle_rgbe or 32-bit_rle_xyze");
        header.xyz = format == "32-bit_rle_xyze";
    }
}

struct Axis {
    char sign, name;
    int length;
};

Axis take_axis(std::string_view& rest, std::string_view line) {
    const std::string_view axis = take_word(rest), count = take_word(rest);
    const std::optional<int> length = number_of<int>(count);
    if (axis.size() != 2 || (axis[0] != '+' && axis[0] != '-') || (axis[1] != 'X' && axis[1] != 'Y') ||
        !length || *length < 0)
        throw Error("is a damaged Radiance HDR: '" + printable(line, 60) +
                    "' is not a resolution such as -Y 512 +X 1024");
    return {axis[0], axis[1], *length};
}

void read_resolution(std::string_view line, RadianceHeader& header) {
    std::string_view rest = line;
    const Axis outer = take_axis(rest, line), inner = take_axis(rest, line);
    if (outer.name == inner.name)
        throw Error("is a damaged Radiance HDR: '" + printable(line, 60) + "' names one axis twice");
    header.columns = outer.name == 'X';
    const Axis &x = header.columns ? outer : inner, &y = header.columns ? inner : outer;
    header.size = {x.length, y.length};
    header.left = x.sign == '-';
    header.up = y.sign == '+';
}

} // namespace

std::size_t RadianceHeader::index(std::size_t line, std::size_t i) const {
    const auto width = static_cast<std::size_t>(size.width), height = static_cast<std::size_t>(size.height);
    std::size_t x = columns ? line : i, y = columns ? i : line;
    x = left ? width - 1 - x : x;
    y = up ? height - 1 - y : y;
    return y * width + x;
}

RadianceHeader read_radiance_header(std::span<const std::byte> file) {
    std::string_view rest(reinterpret_cast<const char*>(file.data()), file.size());
    RadianceHeader header;
    std::optional<std::string_view> line;
    while ((line = take_line(rest)) && !line->empty())
        read_variable(*line, header);
    line = line ? take_line(rest) : std::nullopt;
    if (!line)
        throw Error("is a damaged Radiance HDR: it ends inside its header");
    read_resolution(*line, header);
    header.bytes = file.size() - rest.size();
    return header;
}

} // namespace prt

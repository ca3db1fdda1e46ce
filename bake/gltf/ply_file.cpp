// Reads PLY files. No package of Debian 12 reads them safely: Assimp 5.2 never returns from a file that ends
// in its header.

#include "bake/gltf/ply_file.h"

#include "bake/gltf/mesh_text.h"
#include "prt/core/error.h"
#include "runtime/core/support/printable.h"
#include "runtime/load/srgb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

namespace prt {
namespace {

enum class Form { ascii, little, big };

/// A type of numbers.
struct NumberType {
    std::size_t size;
    bool floating, negative; ///< negative: integers with a sign
    /// Value that means 1 for a color.
    double white() const { return floating ? 1 : size == 1 ? 255 : 65535; }
};

struct Property {
    std::string name;
    NumberType type;                 ///< of the value, or of the items of a list
    std::optional<NumberType> count; ///< of the number of items; empty: not a list
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

NumberType type_of(std::string_view name) {
    constexpr std::pair<std::string_view, NumberType> kTypes[] = {
        {"char", {1, false, true}},    {"uchar", {1, false, false}},  {"short", {2, false, true}},
        {"ushort", {2, false, false}}, {"int", {4, false, true}},     {"uint", {4, false, false}},
        {"float", {4, true, true}},    {"double", {8, true, true}},   {"int8", {1, false, true}},
        {"uint8", {1, false, false}},  {"int16", {2, false, true}},   {"uint16", {2, false, false}},
        {"int32", {4, false, true}},   {"uint32", {4, false, false}}, {"float32", {4, true, true}},
        {"float64", {8, true, true}}};
    for (const auto& [known, type] : kTypes)
        if (name == known)
            return type;
    throw Error("its header has the unknown type '" + printable(std::string(name.substr(0, 40))) + "'");
}

/// Reads the header line by line.
class Header {
public:
    explicit Header(std::string_view text) : rest_(without_mark(text)) {
        if (words(line()) != std::vector<std::string_view>{"ply"})
            throw Error("is not PLY: it does not begin with a line 'ply'");
        for (;;) {
            const std::vector<std::string_view> w = words(line());
            if (w.empty() || w[0] == "comment" || w[0] == "obj_info")
                continue;
            if (w[0] == "end_header")
                break;
            add(w);
        }
        if (!form)
            throw Error("its header has no line 'format'");
    }
    std::optional<Form> form;
    std::vector<Element> elements;
    /// Returns what follows the header.
    std::string_view rest() const { return rest_; }

private:
    std::string_view line() {
        const std::size_t end = rest_.find('\n');
        if (end == std::string_view::npos)
            throw Error("ends in its header");
        const std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return line;
    }
    static std::vector<std::string_view> words(std::string_view line) {
        std::vector<std::string_view> all;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line))
            all.push_back(word);
        return all;
    }
    void add(const std::vector<std::string_view>& w) {
        if (w[0] == "format" && w.size() >= 2) {
            if (w[1] != "ascii" && w[1] != "binary_little_endian" && w[1] != "binary_big_endian")
                throw Error("has the unknown format '" + printable(std::string(w[1].substr(0, 40))) + "'");
            form = w[1] == "ascii" ? Form::ascii : w[1] == "binary_big_endian" ? Form::big : Form::little;
        } else if (w[0] == "element" && w.size() == 3) {
            Element& element = elements.emplace_back(Element{std::string(w[1]), 0, {}});
            const auto [end, error] = std::from_chars(w[2].data(), w[2].data() + w[2].size(), element.count);
            if (error != std::errc() || end != w[2].data() + w[2].size())
                throw Error("its header has no number of elements '" + element.name + "'");
        } else if (w[0] == "property" && !elements.empty() && w.size() == 3) {
            elements.back().properties.push_back({std::string(w[2]), type_of(w[1]), std::nullopt});
        } else if (w[0] == "property" && !elements.empty() && w.size() == 5 && w[1] == "list") {
            elements.back().properties.push_back({std::string(w[4]), type_of(w[3]), type_of(w[2])});
        } else {
            throw Error("its header has an unknown line that begins with '" +
                        printable(std::string(w[0].substr(0, 40))) + "'");
        }
    }
    std::string_view rest_;
};

/// Reads numbers one after another.
class Numbers {
public:
    Numbers(std::string_view data, Form form) : data_(data), form_(form) {}

    double next(const NumberType& type) { return form_ == Form::ascii ? word() : binary(type); }
    /// Throws `Error` if `count` elements of at least `least` numbers cannot be in the rest of the file.
    void check(const Element& element) const {
        std::size_t least = 0;
        for (const Property& p : element.properties)
            least += form_ == Form::ascii ? 2 : p.count ? p.count->size : p.type.size;
        if (element.properties.empty() ? element.count > 0 : element.count > (data_.size() + 1) / least)
            throw Error("is too short for " + std::to_string(element.count) + " elements '" + element.name +
                        "'");
    }

private:
    [[noreturn]] static void end() { throw Error("ends in its data"); }
    double word() {
        const std::size_t begin = data_.find_first_not_of(" \t\r\n");
        if (begin == std::string_view::npos)
            end();
        const std::size_t last = std::min(data_.find_first_of(" \t\r\n", begin), data_.size());
        const double value = number_of(data_.substr(begin, last - begin));
        data_.remove_prefix(last);
        return value;
    }
    double binary(const NumberType& type) {
        if (data_.size() < type.size)
            end();
        std::array<char, 8> bytes{};
        std::memcpy(bytes.data(), data_.data(), type.size);
        data_.remove_prefix(type.size);
        if ((form_ == Form::big) != (std::endian::native == std::endian::big))
            std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.size));
        if (type.floating)
            return type.size == 4 ? static_cast<double>(as<float>(bytes)) : as<double>(bytes);
        switch (type.size) {
        case 1:
            return type.negative ? as<std::int8_t>(bytes) : as<std::uint8_t>(bytes);
        case 2:
            return type.negative ? as<std::int16_t>(bytes) : as<std::uint16_t>(bytes);
        default:
            return type.negative ? as<std::int32_t>(bytes) : as<std::uint32_t>(bytes);
        }
    }
    template <class T>
    static T as(const std::array<char, 8>& bytes) {
        T value;
        std::memcpy(&value, bytes.data(), sizeof(T));
        return value;
    }
    std::string_view data_;
    Form form_;
};

/// Properties of vertices that are read, by slot: position, normal, color, texture coordinate.
constexpr std::size_t kSlots = 11, kNormal = 3, kColor = 6, kTexcoord = 9;
std::optional<std::size_t> slot_of(std::string_view name) {
    constexpr std::pair<std::string_view, std::size_t> kNames[] = {
        {"x", 0},           {"y", 1},         {"z", 2},          {"nx", 3},          {"ny", 4},
        {"nz", 5},          {"red", 6},       {"r", 6},          {"green", 7},       {"g", 7},
        {"blue", 8},        {"b", 8},         {"s", 9},          {"t", 10},          {"u", 9},
        {"v", 10},          {"texture_u", 9}, {"texture_v", 10}, {"diffuse_red", 6}, {"diffuse_green", 7},
        {"diffuse_blue", 8}};
    for (const auto& [known, slot] : kNames)
        if (name == known)
            return slot;
    return std::nullopt;
}

/// Returns a whole number that is not negative. Throws `Error` for another one.
std::uint32_t whole(double value, const char* what) {
    if (!(value >= 0 && value < 4294967295.0 && value == std::floor(value)))
        throw Error(std::string(what) + " is not a whole number from 0 to 2^32 - 2");
    return static_cast<std::uint32_t>(value);
}

/// Returns the number of values of a property.
std::uint32_t count_of(const Property& p, Numbers& numbers) {
    return p.count ? whole(numbers.next(*p.count), "the length of a list") : 1;
}

void read_vertices(const Element& element, Numbers& numbers, MeshArrays& mesh) {
    std::array<bool, kSlots> has{};
    std::vector<std::optional<std::size_t>> slots;
    for (const Property& p : element.properties) {
        slots.push_back(p.count ? std::nullopt : slot_of(p.name));
        if (slots.back())
            has[*slots.back()] = true;
    }
    if (!has[0] || !has[1] || !has[2])
        throw Error("its vertices have no positions x, y, z");
    const auto all = [&](std::size_t first, std::size_t count) {
        return std::all_of(has.begin() + static_cast<std::ptrdiff_t>(first),
                           has.begin() + static_cast<std::ptrdiff_t>(first + count), std::identity());
    };
    const bool normals = all(kNormal, 3), colors = all(kColor, 3), texcoords = all(kTexcoord, 2);
    for (std::size_t v = 0; v < element.count; ++v) {
        std::array<double, kSlots> values{};
        for (std::size_t i = 0; i < slots.size(); ++i) {
            const Property& p = element.properties[i];
            for (std::uint32_t left = count_of(p, numbers); left > 0; --left) {
                const double value = numbers.next(p.type);
                if (slots[i])
                    values[*slots[i]] =
                        *slots[i] >= kColor && *slots[i] < kTexcoord ? value / p.type.white() : value;
            }
        }
        mesh.positions.emplace_back(values[0], values[1], values[2]);
        if (normals)
            mesh.normals.emplace_back(values[3], values[4], values[5]);
        if (colors)
            mesh.colors.emplace_back(srgb_to_linear(values[6]), srgb_to_linear(values[7]),
                                     srgb_to_linear(values[8]));
        if (texcoords)
            mesh.texcoords.emplace_back(values[9], 1 - values[10]);
    }
}

/// Reads polygons: their corners, one after another, and their numbers of corners.
struct Polygons {
    std::vector<std::uint32_t> corners, counts;
};

void read_faces(const Element& element, Numbers& numbers, Polygons& polygons) {
    for (std::size_t f = 0; f < element.count; ++f)
        for (const Property& p : element.properties) {
            const bool corners = p.count && (p.name == "vertex_indices" || p.name == "vertex_index");
            const std::uint32_t count = count_of(p, numbers);
            for (std::uint32_t i = 0; i < count; ++i) {
                const double value = numbers.next(p.type);
                if (corners)
                    polygons.corners.push_back(whole(value, "the index of a vertex"));
            }
            if (corners)
                polygons.counts.push_back(count);
        }
}

void cut(const Polygons& polygons, MeshArrays& mesh) {
    for (const std::uint32_t corner : polygons.corners)
        if (corner >= mesh.positions.size())
            throw Error("a face refers to vertex " + std::to_string(corner) + ", but there are only " +
                        std::to_string(mesh.positions.size()));
    std::size_t first = 0;
    for (const std::uint32_t count : polygons.counts) {
        if (count >= 3)
            append_polygon(std::span(polygons.corners).subspan(first, count), mesh.positions, mesh.triangles);
        first += count;
    }
}

void skip(const Element& element, Numbers& numbers) {
    for (std::size_t e = 0; e < element.count; ++e)
        for (const Property& p : element.properties)
            for (std::uint32_t left = count_of(p, numbers); left > 0; --left)
                numbers.next(p.type);
}

} // namespace

MeshArrays read_ply(std::span<const std::byte> file) {
    const Header header({reinterpret_cast<const char*>(file.data()), file.size()});
    Numbers numbers(header.rest(), *header.form);
    MeshArrays mesh;
    Polygons polygons;
    for (const Element& element : header.elements) {
        numbers.check(element);
        if (element.name == "vertex")
            read_vertices(element, numbers, mesh);
        else if (element.name == "face")
            read_faces(element, numbers, polygons);
        else
            skip(element, numbers);
    }
    cut(polygons, mesh);
    if (!mesh.positions.empty() && mesh.triangles.empty())
        throw Error("has no faces: it is a cloud of points, or has triangle strips, which are not read");
    return mesh;
}

} // namespace prt

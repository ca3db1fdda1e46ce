// Reads OBJ files. tinyobjloader 2.0 drops the first vertex after a byte order mark, reads wrong numbers for
// what is no number, and rejects comments after faces.

#include "bake/gltf/obj_file.h"

#include "bake/gltf/mesh_text.h"
#include "prt/core/error.h"
#include "runtime/core/support/printable.h"
#include "runtime/load/srgb.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

namespace prt {
namespace {

/// Indices of position, texture coordinate and normal of a corner; -1: none.
using Corner = std::array<std::int64_t, 3>;

struct CornerHash {
    std::size_t operator()(const Corner& c) const {
        std::size_t hash = 0;
        for (const std::int64_t index : c)
            hash = (hash ^ static_cast<std::size_t>(index)) * 0x9e3779b97f4a7c15u;
        return hash ^ hash >> 32;
    }
};

class ObjReader {
public:
    explicit ObjReader(std::string_view text) : rest_(without_mark(text)) {
        std::string joined;
        while (!rest_.empty()) {
            ++line_;
            std::string_view line = take_line();
            joined.clear();
            while (line.ends_with('\\') && !rest_.empty()) {
                joined += line.substr(0, line.size() - 1);
                joined += ' ';
                line = take_line();
                ++line_;
            }
            if (!joined.empty())
                line = joined += line;
            read(line.substr(0, line.find('#')));
        }
        check();
    }
    MeshArrays mesh() && {
        MeshArrays result;
        const bool normals = all_have(2), texcoords = all_have(1);
        std::unordered_map<Corner, std::uint32_t, CornerHash> known;
        if (!normals && !texcoords) {
            result.positions = positions_;
            result.colors = colored_ == positions_.size() ? std::move(colors_) : std::vector<glm::vec3>();
        }
        std::vector<std::uint32_t> polygon;
        for (std::size_t face = 0, first = 0; face < faces_.size(); first += faces_[face++]) {
            polygon.clear();
            for (std::size_t i = first; i < first + faces_[face]; ++i) {
                const Corner corner = {corners_[i][0], texcoords ? corners_[i][1] : -1,
                                       normals ? corners_[i][2] : -1};
                if (!normals && !texcoords) {
                    polygon.push_back(static_cast<std::uint32_t>(corner[0]));
                    continue;
                }
                const auto [found, is_new] =
                    known.try_emplace(corner, static_cast<std::uint32_t>(result.positions.size()));
                if (is_new)
                    add(corner, result);
                polygon.push_back(found->second);
            }
            append_polygon(polygon, result.positions, result.triangles);
        }
        return result;
    }

private:
    std::string_view take_line() {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        if (line.ends_with('\r'))
            line.remove_suffix(1);
        return line;
    }
    void read(std::string_view line) {
        const std::string_view kind = next_word(line);
        if (kind == "v")
            read_vertex(line);
        else if (kind == "vt")
            texcoords_.push_back(numbers(line, 1));
        else if (kind == "vn")
            normals_.push_back(numbers(line, 3));
        else if (kind == "f")
            read_face(line);
    }
    /// Reads up to six numbers, of which `least` must exist; the others are 0.
    std::array<double, 6> numbers(std::string_view line, std::size_t least, std::size_t* count = nullptr) {
        std::array<double, 6> values{};
        std::size_t read = 0;
        for (std::string_view word = next_word(line); !word.empty() && read < values.size();
             word = next_word(line))
            values[read++] = at_line([&] { return number_of(word); });
        if (read < least)
            throw Error("line " + std::to_string(line_) + " has " + std::to_string(read) +
                        " numbers instead of " + std::to_string(least));
        if (count)
            *count = read;
        return values;
    }
    void read_vertex(std::string_view line) {
        std::size_t count = 0;
        const std::array<double, 6> v = numbers(line, 3, &count);
        positions_.emplace_back(v[0], v[1], v[2]);
        colors_.emplace_back(srgb_to_linear(v[3]), srgb_to_linear(v[4]), srgb_to_linear(v[5]));
        colored_ += count == 6 ? 1 : 0;
    }
    void read_face(std::string_view line) {
        std::size_t count = 0;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count)
            corners_.push_back(at_line([&] { return corner_of(word); }));
        if (count < 3)
            throw Error("line " + std::to_string(line_) + " has a face of " + std::to_string(count) +
                        " corners");
        faces_.push_back(count);
    }
    /// Parses "v", "v/vt", "v//vn" or "v/vt/vn".
    Corner corner_of(std::string_view word) const {
        Corner corner = {-1, -1, -1};
        const std::array<std::size_t, 3> counts = {positions_.size(), texcoords_.size(), normals_.size()};
        std::string_view left = word;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t end = std::min(left.find('/'), left.size());
            const std::string_view digits = left.substr(0, end);
            std::int64_t index = 0;
            const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
            const bool empty = digits.empty() && i > 0;
            if (!empty && (error != std::errc() || last != digits.data() + digits.size() || index == 0))
                throw Error("has '" + printable(std::string(word.substr(0, 40))) +
                            "' where a corner should be");
            if (!empty)
                corner[i] = index > 0 ? index - 1 : static_cast<std::int64_t>(counts[i]) + index;
            if (!empty && corner[i] < 0)
                throw Error("has '" + printable(std::string(word.substr(0, 40))) +
                            "', which refers to a line that does not exist");
            if (end == left.size())
                return corner;
            left.remove_prefix(end + 1);
        }
        throw Error("has '" + printable(std::string(word.substr(0, 40))) + "' where a corner should be");
    }
    template <class Read>
    auto at_line(Read&& read) const -> decltype(read()) {
        try {
            return read();
        } catch (const Error& error) {
            throw Error("line " + std::to_string(line_) + " " + error.what());
        }
    }
    /// Checks references, which may also be to later lines.
    void check() const {
        const std::array<std::size_t, 3> counts = {positions_.size(), texcoords_.size(), normals_.size()};
        constexpr const char* kWhat[] = {"vertex", "texture coordinate", "normal"};
        for (const Corner& corner : corners_)
            for (std::size_t i = 0; i < 3; ++i)
                if (corner[i] >= static_cast<std::int64_t>(counts[i]))
                    throw Error(std::string("a face refers to ") + kWhat[i] + " " +
                                std::to_string(corner[i] + 1) + ", but there are only " +
                                std::to_string(counts[i]));
    }
    bool all_have(std::size_t index) const {
        return !corners_.empty() &&
               std::ranges::all_of(corners_, [&](const Corner& c) { return c[index] >= 0; });
    }
    void add(const Corner& corner, MeshArrays& result) const {
        const auto at = [](const auto& list, std::int64_t i) { return list[static_cast<std::size_t>(i)]; };
        result.positions.push_back(at(positions_, corner[0]));
        if (colored_ == positions_.size())
            result.colors.push_back(at(colors_, corner[0]));
        if (corner[1] >= 0)
            result.texcoords.emplace_back(at(texcoords_, corner[1])[0], 1 - at(texcoords_, corner[1])[1]);
        if (corner[2] >= 0) {
            const std::array<double, 6> n = at(normals_, corner[2]);
            result.normals.emplace_back(n[0], n[1], n[2]);
        }
    }

    std::string_view rest_;
    std::size_t line_ = 0, colored_ = 0; ///< colored_: number of vertices with a color
    std::vector<glm::dvec3> positions_;
    std::vector<glm::vec3> colors_;
    std::vector<std::array<double, 6>> texcoords_, normals_;
    std::vector<Corner> corners_;
    std::vector<std::size_t> faces_; ///< numbers of corners
};

} // namespace

MeshArrays read_obj(std::span<const std::byte> file) {
    return ObjReader({reinterpret_cast<const char*>(file.data()), file.size()}).mesh();
}

} // namespace prt

// Detects and unfolds cube maps stored as crosses or rows.
#include "runtime/image/cube_cross.h"

#include <array>
#include <cstddef>

namespace prt {
namespace {

/// Cell of a face in a grid of squares.
struct Cell {
    int x, y;
    bool rotated = false; ///< rotated by 180 degrees
};

/// Positions of the faces +X -X +Y -Y +Z -Z in a grid of `width` by `height` cells.
struct Unfolding {
    int width, height;
    std::array<Cell, 6> faces;
};

constexpr Unfolding kUnfoldings[] = {{4, 3, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}}},
                                     {3, 4, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3, true}}}},
                                     {6, 1, {{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}}}};

const glm::vec3& pixel(const Image& image, int x, int y) {
    return image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(x)];
}

/// Returns whether all pixels outside the faces are equal.
bool is_blank_outside(const Image& image, const Unfolding& unfolding, int size) {
    const glm::vec3* outside = nullptr;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            bool in_face = false;
            for (const Cell& cell : unfolding.faces)
                in_face |= cell.x == x / size && cell.y == y / size;
            if (in_face)
                continue;
            const glm::vec3& here = pixel(image, x, y);
            if (outside && here != *outside)
                return false;
            outside = &here;
        }
    return true;
}

} // namespace

std::optional<Image> faces_of_cross(const Image& image) {
    for (const Unfolding& unfolding : kUnfoldings) {
        const int size = image.width / unfolding.width;
        if (size < 1 || image.width != size * unfolding.width || image.height != size * unfolding.height ||
            !is_blank_outside(image, unfolding, size))
            continue;
        Image column{size, 6 * size, {}};
        column.pixels.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(column.height));
        for (const Cell& cell : unfolding.faces)
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x)
                    column.pixels.push_back(pixel(image, cell.x * size + (cell.rotated ? size - 1 - x : x),
                                                  cell.y * size + (cell.rotated ? size - 1 - y : y)));
        return column;
    }
    return std::nullopt;
}

} // namespace prt

// Sorts texels into the cells of a cube, so that texels near a direction are found in any layout.
#include "runtime/fit/sky_map.h"

#include "prt/core/error.h"
#include "runtime/core/support/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace prt {
namespace {

/// Number of cells along an edge of a cube face: they span at most 1.8 degrees.
constexpr int kCells = 64;
constexpr std::size_t kCellCount = std::size_t{6} * kCells * kCells;
/// Upper bound of the distance of a direction from the center of its cell: half the diagonal of the largest
/// cells.
constexpr double kCellRadius = 1.4143 / kCells;

std::size_t cell_of(const glm::dvec3& direction) {
    const glm::dvec3 size = glm::abs(direction);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    const auto at = [&](int other) {
        const double share = 0.5 * (direction[other] / size[axis] + 1);
        return static_cast<std::size_t>(std::clamp(static_cast<int>(share * kCells), 0, kCells - 1));
    };
    const std::size_t face = 2 * static_cast<std::size_t>(axis) + (direction[axis] < 0);
    return (face * kCells + at(next)) * kCells + at(last);
}

glm::dvec3 middle_of(std::size_t cell) {
    const auto at = [](std::size_t i) { return (2.0 * static_cast<double>(i) + 1) / kCells - 1; };
    const std::size_t face = cell / (kCells * kCells);
    const int axis = static_cast<int>(face / 2);
    glm::dvec3 direction;
    direction[axis] = face % 2 == 0 ? 1 : -1;
    direction[(axis + 1) % 3] = at(cell / kCells % kCells);
    direction[(axis + 2) % 3] = at(cell % kCells);
    return glm::normalize(direction);
}

const std::vector<glm::dvec3>& middles() {
    static const std::vector<glm::dvec3> all = [] {
        std::vector<glm::dvec3> list;
        for (std::size_t cell = 0; cell < kCellCount; ++cell)
            list.push_back(middle_of(cell));
        return list;
    }();
    return all;
}

void check_pixels(const Image& image) {
    for (const glm::vec3& pixel : image.pixels)
        for (int c = 0; c < 3; ++c)
            if (!(pixel[c] >= 0 && std::isfinite(pixel[c])))
                throw Error("suns cannot be found in the image: a pixel is negative or not finite");
}

} // namespace

SkyMap::SkyMap(Environment environment, int threads)
    : texels_(environment), environment_(std::move(environment)), threads_(threads),
      first_(kCellCount + 1, 0) {
    check_pixels(environment_.image);
    std::vector<std::uint32_t> cell(texels_.count());
    std::vector<Placed> placed(texels_.count());
    parallel_for(cell.size(), 1 << 14, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 w = texels_.direction(i);
            placed[i] = {glm::vec3(w), static_cast<float>(texels_.solid_angle(i)),
                         static_cast<std::uint32_t>(i)};
            cell[i] = static_cast<std::uint32_t>(placed[i].solid_angle > 0 ? cell_of(w) : kCellCount);
        }
    });
    for (const std::uint32_t c : cell)
        if (c < kCellCount)
            ++first_[c + 1];
    for (std::size_t c = 0; c < kCellCount; ++c)
        first_[c + 1] += first_[c];
    sorted_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < cell.size(); ++i)
        if (cell[i] < kCellCount)
            sorted_[next[cell[i]]++] = placed[i];
}

std::span<const SkyMap::Placed> SkyMap::texels_of(std::size_t cell) const {
    return std::span(sorted_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
}

std::vector<NearTexel> SkyMap::near(const glm::dvec3& direction, double angle) const {
    std::vector<NearTexel> found;
    const double reach = angle + kCellRadius, cosine = reach < 3.14 ? std::cos(reach) : -1;
    const double longest = angle < 3.14 ? 2 * std::sin(0.5 * angle) : 3;
    for (std::size_t cell = 0; cell < kCellCount; ++cell) {
        if (glm::dot(middles()[cell], direction) < cosine)
            continue;
        for (const Placed& placed : texels_of(cell)) {
            // Use the chord, which resolves small angles.
            const glm::dvec3 w(placed.direction);
            const double chord = glm::distance(w, direction);
            if (chord <= longest)
                found.push_back({placed.texel, w, 2 * std::asin(std::min(1.0, 0.5 * chord)),
                                 static_cast<double>(placed.solid_angle),
                                 glm::dvec3(environment_.image.pixels[placed.texel])});
        }
    }
    return found;
}

std::vector<SkyCell> SkyMap::cells() const {
    std::vector<SkyCell> cells(kCellCount);
    parallel_for(kCellCount, 64, threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            SkyCell& cell = cells[c];
            glm::dvec3 sum(0);
            for (const Placed& placed : texels_of(c)) {
                const glm::dvec3 color(environment_.image.pixels[placed.texel]);
                const double area = static_cast<double>(placed.solid_angle), value = brightness(color);
                cell.flux += area * color;
                sum += area * value * glm::dvec3(placed.direction);
                if (value > cell.most) {
                    cell.most = value;
                    cell.brightest = placed.texel;
                }
            }
            cell.direction = glm::length(sum) > 0 ? glm::normalize(sum) : middles()[c];
        }
    });
    return cells;
}

} // namespace prt

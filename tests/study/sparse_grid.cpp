// Finds the cells of receivers in a regular grid.

#include "sparse_grid.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace prt {
namespace {

struct Box {
    glm::dvec3 least{std::numeric_limits<double>::max()}, most{std::numeric_limits<double>::lowest()};
};

Box box_of(std::span<const glm::vec3> positions) {
    Box box;
    for (const glm::vec3& position : positions) {
        box.least = glm::min(box.least, glm::dvec3(position));
        box.most = glm::max(box.most, glm::dvec3(position));
    }
    return box;
}

glm::ivec3 corner_offset(std::size_t corner) {
    return {static_cast<int>(corner & 1), static_cast<int>(corner >> 1 & 1), static_cast<int>(corner >> 2)};
}

/// Returns the interpolation weights at `point`, in edges from the minimum corner of a cell.
std::array<float, kCorners> shares_of(const glm::dvec3& point) {
    std::array<float, kCorners> shares{};
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
        const glm::dvec3 at(corner_offset(corner)), s = 1.0 - glm::abs(point - at);
        shares[corner] = static_cast<float>(s.x * s.y * s.z);
    }
    return shares;
}

std::array<int, 3> key_of(const glm::ivec3& point) {
    return {point.z, point.y, point.x};
}

/// Numbers positions in the order in which they are requested.
class NodeNumbers {
public:
    explicit NodeNumbers(std::vector<glm::ivec3>& points) : positions_(points) {}
    std::uint32_t operator()(const glm::ivec3& point) {
        const auto [at, is_new] =
            numbers_.try_emplace(key_of(point), static_cast<std::uint32_t>(positions_.size()));
        if (is_new)
            positions_.push_back(point);
        return at->second;
    }

private:
    std::vector<glm::ivec3>& positions_;
    std::map<std::array<int, 3>, std::uint32_t> numbers_;
};

/// Numbers the nodes of `cell` that have a share in any of its receivers.
void number_nodes(const SparseGrid& grid, const glm::ivec3& point, SparseGrid::Cell& cell,
                  NodeNumbers& number_of) {
    std::array<bool, kCorners> needed{};
    for (std::size_t i = cell.begin; i < cell.end; ++i)
        for (std::size_t corner = 0; corner < kCorners; ++corner)
            needed[corner] = needed[corner] || grid.share[i][corner] > 0;
    const auto first =
        static_cast<std::size_t>(std::find(needed.begin(), needed.end(), true) - needed.begin());
    for (std::size_t corner = 0; corner < kCorners; ++corner)
        cell.nodes[corner] = number_of(point + corner_offset(needed[corner] ? corner : first));
}

} // namespace

double longest_edge(std::span<const glm::vec3> positions) {
    const Box box = box_of(positions);
    const glm::dvec3 edges = positions.empty() ? glm::dvec3(0) : box.most - box.least;
    return std::max({edges.x, edges.y, edges.z});
}

SparseGrid sparse_grid(std::span<const glm::vec3> positions, double size) {
    SparseGrid grid;
    grid.size = size;
    const Box box = box_of(positions);
    const glm::ivec3 last = glm::max(glm::ivec3(glm::ceil((box.most - box.least) / size)) - 1, 0);
    std::vector<glm::ivec3> cells;
    for (const glm::vec3& position : positions)
        cells.push_back(glm::min(glm::ivec3((glm::dvec3(position) - box.least) / size), last));
    grid.receivers.resize(positions.size());
    std::iota(grid.receivers.begin(), grid.receivers.end(), 0u);
    std::stable_sort(grid.receivers.begin(), grid.receivers.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key_of(cells[a]) < key_of(cells[b]); });
    for (const std::uint32_t p : grid.receivers)
        grid.share.push_back(shares_of((glm::dvec3(positions[p]) - box.least) / size - glm::dvec3(cells[p])));
    NodeNumbers number_of(grid.nodes);
    for (std::size_t begin = 0; begin < positions.size(); begin = grid.cells.back().end) {
        const glm::ivec3 point = cells[grid.receivers[begin]];
        SparseGrid::Cell cell{{}, begin, begin};
        while (cell.end < positions.size() && cells[grid.receivers[cell.end]] == point)
            ++cell.end;
        number_nodes(grid, point, cell, number_of);
        grid.cells.push_back(cell);
    }
    grid.nodes_of_box = static_cast<std::size_t>(last.x + 2) * static_cast<std::size_t>(last.y + 2) *
                        static_cast<std::size_t>(last.z + 2);
    return grid;
}

std::vector<CoarseCorners> corners_in(const SparseGrid& coarse, const SparseGrid& fine) {
    std::map<std::array<int, 3>, std::uint32_t> numbers;
    for (std::size_t n = 0; n < coarse.nodes.size(); ++n)
        numbers[key_of(coarse.nodes[n])] = static_cast<std::uint32_t>(n);
    std::vector<CoarseCorners> result;
    for (const glm::ivec3& point : fine.nodes) {
        const glm::ivec3 cell = point / 2;
        CoarseCorners corners{{}, shares_of(glm::dvec3(point) / 2.0 - glm::dvec3(cell))};
        for (std::size_t corner = 0; corner < kCorners; ++corner) {
            if (const auto at = numbers.find(key_of(cell + corner_offset(corner))); at != numbers.end())
                corners.nodes[corner] = at->second;
            else // A node that no receiver of the coarse grid needs has no share in one that the fine one
                 // has.
                corners.share[corner] = 0;
        }
        result.push_back(corners);
    }
    return result;
}

} // namespace prt

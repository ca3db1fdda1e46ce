// Finds the receivers at the position of a vertex.

#include "bake/scene/positions_without_area.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <tuple>

namespace prt {

void fill_without_area(const Receivers& receivers, std::size_t fronts, Transfer& transfer) {
    std::vector<std::uint32_t> lit, dark;
    for (std::uint32_t p = 0; p < fronts; ++p)
        if (receivers.normals[p] != glm::vec3(0))
            (receivers.areas[p] > 0 ? lit : dark).push_back(p);
    if (dark.empty())
        return;
    const auto position = [&](std::uint32_t p) {
        const glm::vec3& at = receivers.positions[p];
        return std::tuple(at.x, at.y, at.z);
    };
    std::ranges::stable_sort(lit, {}, position);
    for (const std::uint32_t p : dark) {
        const auto first = std::ranges::lower_bound(lit, position(p), {}, position),
                   end = std::ranges::upper_bound(lit, position(p), {}, position);
        if (first == end)
            continue;
        const auto alike = [&](std::uint32_t q) {
            return glm::dot(receivers.normals[p], receivers.normals[q]);
        };
        const std::uint32_t nearest = *std::ranges::max_element(first, end, {}, alike);
        std::ranges::copy(transfer.vector(nearest), transfer.vector(p).begin());
    }
}

} // namespace prt

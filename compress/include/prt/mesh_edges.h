#pragma once

#include "prt/scene.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Two receivers that a triangle joins, first < second.
struct Edge {
    std::uint32_t first, second;
    friend bool operator==(const Edge&, const Edge&) = default;
    friend auto operator<=>(const Edge&, const Edge&) = default;
};

/// The edges of all triangles, each once, in ascending order.
std::vector<Edge> mesh_edges(const Scene& scene);

} // namespace prt

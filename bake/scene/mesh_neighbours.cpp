#include "scene/mesh_neighbours.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace prt {
namespace {

/// For every receiver the first one with the same position and normal.
std::vector<std::uint32_t> places_of(const Receivers& receivers, std::size_t fronts) {
    const auto key = [&](std::uint32_t i) {
        const glm::vec3 &p = receivers.positions[i], &n = receivers.normals[i];
        return std::tuple(p.x, p.y, p.z, n.x, n.y, n.z);
    };
    std::vector<std::uint32_t> order(fronts), place(receivers.size());
    std::iota(order.begin(), order.end(), 0u);
    std::iota(place.begin(), place.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    for (std::size_t i = 1; i < order.size(); ++i)
        if (key(order[i]) == key(order[i - 1]))
            place[order[i]] = place[order[i - 1]];
    return place;
}

} // namespace

MeshNeighbours::MeshNeighbours(const Surfaces& surfaces, const Receivers& receivers, std::size_t fronts)
    : place_(places_of(receivers, fronts)), first_(receivers.size() + 1, 0) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(6 * surfaces.triangles());
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const glm::uvec3& c = surfaces.corners(t);
        for (int i = 0; i < 3; ++i)
            for (const int j : {(i + 1) % 3, (i + 2) % 3})
                if (place_[c[i]] != place_[c[j]])
                    edges.emplace_back(place_[c[i]], place_[c[j]]);
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const auto& [from, to] : edges)
        ++first_[from + 1];
    for (std::size_t i = 1; i < first_.size(); ++i)
        first_[i] += first_[i - 1];
    neighbours_.reserve(edges.size());
    for (const auto& [from, to] : edges)
        neighbours_.push_back(to);
}

Refill::Refill(const MeshNeighbours& neighbours, const std::vector<bool>& sealed) {
    std::vector<bool> known(sealed.size());
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t p = 0; p < sealed.size(); ++p) {
        known[p] = !sealed[p];
        if (sealed[p])
            waiting.push_back(p);
    }
    while (!waiting.empty()) {
        const std::size_t before = steps_.size();
        std::vector<std::uint32_t> still;
        for (const std::uint32_t p : waiting) {
            Step step{p, {}};
            for (const std::uint32_t q : neighbours.of(p))
                if (known[q])
                    step.sources.push_back(q);
            if (step.sources.empty())
                still.push_back(p);
            else
                steps_.push_back(std::move(step));
        }
        if (steps_.size() == before)
            return;
        for (std::size_t s = before; s < steps_.size(); ++s)
            known[steps_[s].receiver] = true; // only now: a ring is filled from the one before
        waiting = std::move(still);
    }
}

} // namespace prt

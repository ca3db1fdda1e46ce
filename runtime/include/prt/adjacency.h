#pragma once

// Receivers that a mesh joins: edges, and the neighbours of each receiver. Experimental.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Two receivers that a triangle joins, first < second.
struct Edge {
    std::uint32_t first, second;
    friend bool operator==(const Edge&, const Edge&) = default;
    friend auto operator<=>(const Edge&, const Edge&) = default;
};

/// Returns `edges` in ascending order, each once, with its ends in order; those with one end only go.
std::vector<Edge> unique_edges(std::vector<Edge> edges);

/// The neighbours of each receiver, one list after the other.
class Adjacency {
public:
    /// `edges` as `unique_edges` returns them, between receivers 0 .. `receivers` - 1.
    Adjacency(std::span<const Edge> edges, std::size_t receivers);

    std::size_t receivers() const { return first_.size() - 1; }
    /// The neighbours of `receiver` in ascending order.
    std::span<const std::uint32_t> of(std::size_t receiver) const {
        return std::span(neighbours_).subspan(first_[receiver], degree(receiver));
    }
    std::size_t degree(std::size_t receiver) const { return first_[receiver + 1] - first_[receiver]; }
    /// Index of the first neighbour of `receiver` among those of all, for values beside them.
    std::size_t first(std::size_t receiver) const { return first_[receiver]; }
    /// Twice the number of edges.
    std::size_t size() const { return neighbours_.size(); }

private:
    std::vector<std::size_t> first_; ///< [receivers + 1]
    std::vector<std::uint32_t> neighbours_;
};

} // namespace prt

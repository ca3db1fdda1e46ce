#pragma once

// Mesh edges between receivers, and the neighbours of each receiver. Experimental.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Edge between two neighbouring receivers, such as two vertices of one triangle; first < second.
struct Edge {
    std::uint32_t first, second;
    friend bool operator==(const Edge&, const Edge&) = default;
    friend auto operator<=>(const Edge&, const Edge&) = default;
};

/// Returns `edges` sorted in ascending order, without duplicates, each with first < second. Edges with two
/// equal ends are removed.
std::vector<Edge> unique_edges(std::vector<Edge> edges);

/// The neighbours of each receiver in compressed sparse rows.
class Adjacency {
public:
    /// Builds the lists from `edges`, as returned by `unique_edges`, between receivers 0 .. `receivers` - 1.
    Adjacency(std::span<const Edge> edges, std::size_t receivers);

    std::size_t receivers() const { return first_.size() - 1; }
    /// Returns the neighbours of `receiver` in ascending order.
    std::span<const std::uint32_t> of(std::size_t receiver) const {
        return std::span(neighbours_).subspan(first_[receiver], degree(receiver));
    }
    /// Returns the number of neighbours of `receiver`.
    std::size_t degree(std::size_t receiver) const { return first_[receiver + 1] - first_[receiver]; }
    /// Index of the first neighbour of `receiver` in the concatenated lists, for arrays with one value per
    /// neighbour.
    std::size_t first(std::size_t receiver) const { return first_[receiver]; }
    /// Length of all lists together: twice the number of edges.
    std::size_t size() const { return neighbours_.size(); }

private:
    std::vector<std::size_t> first_; ///< [receivers + 1]
    std::vector<std::uint32_t> neighbours_;
};

} // namespace prt

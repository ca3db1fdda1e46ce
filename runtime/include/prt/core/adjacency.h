#pragma once

// Mesh edges between receivers, and the neighbours of each receiver. Experimental.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Edge between two neighbouring receivers, such as two vertices of one triangle. `first` and `second` are
/// the indices of the receivers; usually first < second, as `unique_edges` ensures.
struct Edge {
    std::uint32_t first, second;
    friend bool operator==(const Edge&, const Edge&) = default;
    friend auto operator<=>(const Edge&, const Edge&) = default;
};

/// Returns `edges` sorted by `first`, then by `second`, each with first < second. Swaps the ends of edges
/// with first > second. Removes duplicates and edges whose two ends are equal.
std::vector<Edge> unique_edges(std::vector<Edge> edges);

/// The neighbours of each receiver: one list per receiver, all lists concatenated in the order of receivers
/// (compressed sparse rows).
class Adjacency {
public:
    /// Builds the lists from `edges`, the result of `unique_edges`. Both ends of every edge must be less than
    /// `receivers`, the number of receivers. Neither is checked.
    Adjacency(std::span<const Edge> edges, std::size_t receivers);

    /// Returns the number of receivers.
    std::size_t receivers() const { return first_.size() - 1; }
    /// Returns the neighbours of `receiver` in ascending order; empty if it has no edge. The span refers into
    /// this object.
    std::span<const std::uint32_t> of(std::size_t receiver) const {
        return std::span(neighbours_).subspan(first_[receiver], degree(receiver));
    }
    /// Returns the number of neighbours of `receiver`.
    std::size_t degree(std::size_t receiver) const { return first_[receiver + 1] - first_[receiver]; }
    /// Returns the index of the first neighbour of `receiver` in the concatenated lists. Use it for an array
    /// [size()] with one value per receiver and neighbour.
    std::size_t first(std::size_t receiver) const { return first_[receiver]; }
    /// Returns the length of the concatenated lists: twice the number of edges.
    std::size_t size() const { return neighbours_.size(); }

private:
    std::vector<std::size_t> first_;        ///< [receivers + 1] start of each list in `neighbours_`
    std::vector<std::uint32_t> neighbours_; ///< [size()] concatenated lists
};

} // namespace prt

#pragma once

// Decoding of compressed transfer to transfer vectors.

#include "prt/core/clustered_transfer.h"
#include "runtime/core/transfer/evaluate_range.h"

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Decodes compressed transfer, receiver by receiver. Keeps a reference. The constructor throws `Error` if
/// `transfer` lacks the coordinates of its predictors.
class ClusteredVectors {
public:
    explicit ClusteredVectors(const ClusteredTransfer& transfer)
        : transfer_(transfer), layouts_(cluster_layouts(transfer.bases)),
          dimension_(transfer.bases.dimension()),
          max_components_(static_cast<std::size_t>(transfer.bases.max_components())) {
        check_coordinates(transfer);
        check_rows(transfer.bases);
    }

    /// Writes the vectors of consecutive receivers, starting at `first`, to `to` [n][dimension]. The size of
    /// `to` determines their number n.
    void read(std::size_t first, std::span<float> to) const;

private:
    const ClusteredTransfer& transfer_;
    std::vector<ClusterLayout> layouts_;
    std::size_t dimension_, max_components_;
};

} // namespace prt

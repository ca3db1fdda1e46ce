#pragma once

// Uniform access to transfer vectors that are stored as floats, as float16, or compressed. Code that reads
// them block by block needs no float copy of all vectors. Experimental.

#include "prt/clustered_transfer.h"
#include "prt/transfer.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// Transfer as stored in a file: floats, or float16, which needs half the memory and converts to float
/// exactly.
struct StoredTransfer {
    TransferLayout layout;
    std::vector<float> floats;         ///< [receivers][layout.dimension()], or empty
    std::vector<std::uint16_t> halves; ///< [receivers][layout.dimension()] as float16, or empty

    std::size_t receivers() const;
};

/// Reads transfer vectors. Refers to `Transfer` objects; copies a `Read` function, and is thread-safe if that
/// is.
class TransferView {
public:
    /// Function that writes the vectors of consecutive receivers, starting at `first`, to `to`
    /// [n][dimension]. The size of `to` determines their number n.
    using Read = std::function<void(std::size_t first, std::span<float> to)>;

    TransferView(const Transfer& transfer);
    TransferView(const StoredTransfer& transfer);
    /// Decodes the compressed vectors block by block, as `decode` does.
    TransferView(const ClusteredTransfer& transfer);
    TransferView(TransferLayout layout, std::size_t receivers, Read read);

    const TransferLayout& layout() const { return layout_; }
    std::size_t dimension() const { return dimension_; }
    std::size_t receivers() const { return receivers_; }
    /// Reads the vectors of receivers first, first + 1, ... into `to` [n][dimension()].
    void read(std::size_t first, std::span<float> to) const { read_(first, to); }

private:
    TransferLayout layout_;
    std::size_t dimension_, receivers_;
    Read read_;
};

/// Returns a view that applies `as_combined` of prt/transfer.h to each vector.
TransferView as_combined(TransferView transfer);
/// Returns a view in another order: its receiver p is receiver order[p] of `transfer`. `order` is
/// [receivers].
TransferView in_order(TransferView transfer, std::vector<std::uint32_t> order);

} // namespace prt

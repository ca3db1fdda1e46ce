#pragma once

// Transfer vectors wherever they are: as floats, as a file holds them, or compressed. Who reads them by
// blocks needs no copy of all as floats. Experimental.

#include "prt/clustered_transfer.h"
#include "prt/transfer.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// Transfer as a file holds it: half of the memory where that is float16, from which floats come exactly.
struct StoredTransfer {
    TransferLayout layout;
    std::vector<float> floats;         ///< [receivers][layout.dimension()], or nothing
    std::vector<std::uint16_t> halves; ///< the same as float16, or nothing

    std::size_t receivers() const;
};

/// Reads the vectors of one of these; keeps a reference to what it was made of. Threads may share it.
class TransferView {
public:
    /// Writes the vectors of receivers from `first` on, as many as `to` [..][dimension] has room for.
    using Read = std::function<void(std::size_t first, std::span<float> to)>;

    TransferView(const Transfer& transfer);
    TransferView(const StoredTransfer& transfer);
    /// The vectors that the compressed form stands for: `decode`, block by block.
    TransferView(const ClusteredTransfer& transfer);
    TransferView(TransferLayout layout, std::size_t receivers, Read read);

    const TransferLayout& layout() const { return layout_; }
    std::size_t dimension() const { return dimension_; }
    std::size_t receivers() const { return receivers_; }
    void read(std::size_t first, std::span<float> to) const { read_(first, to); }

private:
    TransferLayout layout_;
    std::size_t dimension_, receivers_;
    Read read_;
};

/// `as_whole` of prt/transfer.h, vector by vector.
TransferView as_whole(TransferView transfer);
/// Receiver order[p] at place p; `order` [receivers] is kept.
TransferView in_order(TransferView transfer, std::vector<std::uint32_t> order);

} // namespace prt

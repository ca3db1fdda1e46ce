#pragma once

// Uniform read access to transfer vectors that are stored as floats, as float16, or compressed. Code that
// reads the vectors in blocks needs no float copy of all of them. Experimental.

#include "prt/core/clustered_transfer.h"
#include "prt/core/transfer.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// Raw transfer in the number format of its file. Either `floats` or `halves` has data. Float16 needs half
/// the memory of float and converts to float exactly.
struct StoredTransfer {
    TransferLayout layout;             ///< the same for all receivers
    std::vector<float> floats;         ///< [receivers][layout.dimension()]; empty if `halves` is used
    std::vector<std::uint16_t> halves; ///< [receivers][layout.dimension()] bits of finite float16 numbers;
                                       ///< empty if `floats` is used

    /// Returns the number of receivers; 0 if layout.dimension() is 0, for example because there are no terms.
    std::size_t receivers() const;
};

/// Reads the transfer vectors of a list of receivers, in blocks, as floats. A view of a `Transfer`,
/// `StoredTransfer` or `ClusteredTransfer` keeps a reference to that object, which must outlive the view and
/// all copies of the view, and must not change meanwhile; the view is thread-safe. A view of a `Read`
/// function owns a copy of the function, and is thread-safe if the function is.
class TransferView {
public:
    /// Function that writes the transfer vectors of n consecutive receivers, the first with index `first`, to
    /// `to` [n][dimension]. The size of `to` determines n.
    using Read = std::function<void(std::size_t first, std::span<float> to)>;

    /// Views `transfer`, without a copy of its vectors. Keeps a reference to `transfer`.
    TransferView(const Transfer& transfer);
    /// Views `transfer`; `read` converts float16 to float. Keeps a reference to `transfer`.
    TransferView(const StoredTransfer& transfer);
    /// Views compressed transfer; `read` decompresses only the requested vectors, with the same result as
    /// `decode`. Keeps a reference to `transfer`.
    TransferView(const ClusteredTransfer& transfer);
    /// Creates a view that reads with the function `read`, for example from a file. `receivers` is the number
    /// of receivers; each vector has layout.dimension() coefficients.
    TransferView(TransferLayout layout, std::size_t receivers, Read read);

    /// Layout of the vectors that `read` writes.
    const TransferLayout& layout() const { return layout_; }
    /// Number of coefficients of one transfer vector.
    std::size_t dimension() const { return dimension_; }
    /// Number of receivers.
    std::size_t receivers() const { return receivers_; }
    /// Writes the transfer vectors of n consecutive receivers, the first with index `first`, to `to`
    /// [n][dimension()]. The size of `to` determines n. Requires first + n <= receivers(), which is not
    /// checked. Throws only the errors of the function `Read`, if the view has one.
    void read(std::size_t first, std::span<float> to) const { read_(first, to); }

private:
    TransferLayout layout_;
    std::size_t dimension_, receivers_;
    Read read_;
};

/// Returns a view whose vectors are those of `transfer` after `as_combined` of prt/core/transfer.h: one
/// `combined` term replaces all terms of distant light. The object that `transfer` refers to must outlive the
/// result. Requires layout.outputs = 1 and at least one term.
TransferView as_combined(TransferView transfer);
/// Returns a view of order.size() receivers in another sequence: its receiver p is receiver order[p] of
/// `transfer`. Indices may be omitted or repeated; each must be less than transfer.receivers(), which is not
/// checked. The object that `transfer` refers to must outlive the result.
TransferView in_order(TransferView transfer, std::vector<std::uint32_t> order);

} // namespace prt

#pragma once

// Transfer vectors as matrices.

#include "prt/core/transfer_view.h"

#include <Eigen/Core>

namespace prt {

/// Returns the vectors of receivers [begin, end) as columns.
inline Eigen::MatrixXf columns_of(const TransferView& transfer, std::size_t begin, std::size_t end) {
    Eigen::MatrixXf columns(static_cast<Eigen::Index>(transfer.dimension()),
                            static_cast<Eigen::Index>(end - begin));
    transfer.read(begin, {columns.data(), static_cast<std::size_t>(columns.size())});
    return columns;
}

} // namespace prt

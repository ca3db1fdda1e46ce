#pragma once

#include "moving_basis_fit.h"

namespace prt {

/// A moving basis in few bits.
struct MovingBasisCode {
    RowMatrix values;           ///< [points][dimension], decoded
    double error = 0;           ///< squared
    double table_bytes = 0;     ///< size of rows, positions of nodes and ranges of weights
    std::size_t components = 0; ///< that have bits
};

/// Codes a fit: weights of a receiver have `bits` together, divided between components by their energy; rows
/// are rounded to a step that adds about `row_share` of the squared error.
MovingBasisCode code_moving_basis(const GridPoints& points, MovingBasisFit fit, int bits, double row_share);

} // namespace prt

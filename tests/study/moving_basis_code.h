#pragma once

#include "moving_basis_fit.h"

namespace prt {

/// A moving basis in few bits.
struct MovingBasisCode {
    RowMatrix values;           ///< [points][dimension], decoded
    double error = 0;           ///< squared
    double table_bytes = 0;     ///< of rows, of the places of nodes and of the reach of weights
    std::size_t components = 0; ///< that have bits
};

/// Weights of `bits` together, which the components divide by what they carry; rows rounded to a step that
/// adds about `row_share` of the squared error.
MovingBasisCode code_moving_basis(const GridPoints& points, MovingBasisFit fit, int bits, double row_share);

} // namespace prt

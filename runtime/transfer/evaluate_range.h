#pragma once

// Evaluation of compressed transfer for a range of receivers.

#include "prt/core/clustered_transfer.h"

namespace prt {

/// Throws `Error` unless `transfer` has the coordinates of its predictors.
void check_coordinates(const ClusteredTransfer& transfer);

/// Throws `Error` if `free_rows` freed the rows.
void check_rows(const ClusteredBases& bases);

/// Computes exit radiance of receivers [begin, end) from the constants; `radiance` starts at receiver
/// `begin`. Allocates nothing.
void evaluate_range(const ClusteredReceivers& receivers, const ClusterLayout* layouts,
                    const glm::vec4* constants, std::size_t begin, std::size_t end, glm::vec3* radiance);

} // namespace prt

#pragma once

#include "prt/clustered_transfer.h"

namespace prt {

/// Exit radiance of receivers [begin, end) from formed constants; `radiance` is that of receiver `begin`.
/// Allocates nothing.
void evaluate_range(const ClusteredReceivers& receivers, const ClusterLayout* layouts,
                    const glm::vec4* constants, std::size_t begin, std::size_t end, glm::vec3* radiance);

} // namespace prt

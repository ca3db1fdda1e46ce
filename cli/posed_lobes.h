#pragma once

// Lobes as transfer of the pose that a file stands in, for what draws it so.

#include "inputs.h"

namespace prt::cli {

/// The transfer that the lobes of `model`, which has some, are together in the pose of the file: `whole`, of
/// one channel and as many bands as they have.
BakedTransfer lobes_as_transfer(const SceneFile& model);

} // namespace prt::cli

#pragma once

// A bake done again with another seed: what differs is the noise of rays.

#include "inputs.h"
#include "prt/bake.h"
#include "prt/support/progress.h"
#include "prt/transfer.h"

namespace prt::cli {

/// How a bake was made, as far as its record says; lamps are left out.
BakeOptions options_of(const BakeRecord& record, int order, int threads);

/// The transfer of `model` by rays of their own, without lamps. Throws `Error` where it comes out otherwise
/// than noise explains: what the record does not tell was another.
Transfer repeated_bake(const SceneFile& model, int threads, const Progress& progress);

} // namespace prt::cli

#pragma once

#include "prt/core/transfer_volume.h"
#include "support/glb_file.h"

namespace prt::test {

/// The file of a scene with a volume.
GlbFile with_volume(const GlbFile& scene, const CompressedVolume& volume);

} // namespace prt::test

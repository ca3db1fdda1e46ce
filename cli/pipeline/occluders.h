#pragma once

#include "cli/report/report.h"
#include "prt/bake/ambient_occlusion.h"
#include "prt/gltf/gltf.h"

namespace prt::pipeline {

/// Bakes the occlusion volume of each rigid part of `scene`, and writes it into `document`, from which
/// `scene` was extracted.
Report bake_occluders(GltfDocument& document, const Scene& scene, const OccluderOptions& options,
                      const Progress& progress);

} // namespace prt::pipeline

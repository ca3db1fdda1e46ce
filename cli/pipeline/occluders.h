#pragma once

#include "cli/pipeline/host.h"
#include "cli/report/report.h"
#include "prt/bake/ambient_occlusion.h"
#include "prt/gltf/gltf.h"

namespace prt::pipeline {

/// Settings of `bake_occluders`.
struct OccluderRequest {
    OccluderOptions options;
    Path high_poly;      ///< model whose triangles replace those of objects with the same names; may be empty
    GltfOptions reading; ///< of `high_poly`
    Notify notify;       ///< receives notices about `high_poly`
};

/// Bakes the occlusion volume of each rigid part of `scene`, and writes it into `document`, from which
/// `scene` was extracted.
Report bake_occluders(GltfDocument& document, const Scene& scene, const OccluderRequest& request,
                      const Progress& progress);

} // namespace prt::pipeline

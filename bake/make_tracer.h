#pragma once

#include "prt/bake.h"
#include "prt/ray_scene.h"
#include "prt/surfaces.h"

#include <memory>

namespace prt {

/// The tracer that `options` ask for. Keeps references to its arguments. Throws `Error` where the backend is
/// not there.
std::unique_ptr<Tracer> make_tracer(const Scene& scene, const RayScene& rays, const Surfaces& surfaces,
                                    const BakeOptions& options);

} // namespace prt

#pragma once

#include "prt/bake.h"
#include "prt/ray_scene.h"
#include "prt/surfaces.h"

#include <memory>

namespace prt {

/// The tracer that `options` ask for: on a hardware GPU where the backend is automatic and there is one.
/// Keeps references to its arguments. Throws `Error` where the backend is not there.
std::unique_ptr<Tracer> make_tracer(const Scene& scene, const RayScene& rays, const Surfaces& surfaces,
                                    const std::vector<Texture>& textures, const BakeOptions& options);

} // namespace prt

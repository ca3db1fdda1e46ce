#pragma once

// How much light errs where voxels stand in for meshes.

#include "prt/far_blockers.h"
#include "prt/receivers.h"
#include "prt/trace_scene.h"
#include "prt/tracer.h"

#include <optional>
#include <span>

namespace prt {

/// The figures of what stands in for meshes in `tracer`, with the error of direct light of `order` at some of
/// the receivers `indices`, by so many more rays that their noise does not matter. Nothing where nothing
/// stands in.
std::optional<FarBlockerFigures> far_figures(Tracer& tracer, const TraceScene& scene,
                                             const Receivers& receivers,
                                             std::span<const std::uint32_t> indices, int order);

} // namespace prt

#pragma once

#include "prt/gl_objects.h"
#include "prt/trace_scene.h"

#include <span>

namespace prt {

/// A buffer with a gpu::Receiver for each index.
GlObject upload_receivers(const TraceScene& scene, const Receivers& receivers,
                          std::span<const std::uint32_t> indices, std::uint64_t seed);

} // namespace prt

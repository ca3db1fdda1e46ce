#pragma once

#include "prt/bake.h"
#include "prt/trace_scene.h"
#include "prt/tracer.h"

#include <memory>

namespace prt {

/// Throws `Error` for options outside their range, and for those that do not go together.
void check_options(const BakeOptions& options);

/// Keeps a reference to `scene`. Throws `Error` where the backend is not there.
std::unique_ptr<Tracer> make_bake_tracer(const TraceScene& scene, const BakeOptions& options);

} // namespace prt

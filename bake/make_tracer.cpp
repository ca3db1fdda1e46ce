#include "make_tracer.h"

#include "prt/embree_tracer.h"
#include "prt/error.h"

namespace prt {

std::unique_ptr<Tracer> make_tracer(const Scene&, const RayScene& rays, const Surfaces& surfaces,
                                    const BakeOptions& options) {
    return std::make_unique<EmbreeTracer>(rays, options.threads, &surfaces);
}

} // namespace prt

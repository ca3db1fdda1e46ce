// Chooses between the tracers.

#include "prt/make_tracer.h"

#include "prt/support/error.h"
#include "trace/embree_tracer.h"
#include "trace/gpu/gl_rasterizer.h"
#include "trace/gpu/gl_tracer.h"

namespace prt {

std::unique_ptr<Tracer> make_tracer(const TraceScene& scene, const TracerChoice& choice) {
    const bool raster = choice.method == BakeMethod::raster;
    std::unique_ptr<GlContext> context;
    if (choice.backend != Backend::cpu) {
        std::string why;
        context =
            GlContext::create(choice.backend == Backend::gpu ? GlDevice::any : GlDevice::hardware, &why);
        if (!context && (choice.backend == Backend::gpu || raster))
            throw Error("there is no OpenGL 4.5 to bake on (" + why + ")" +
                        (choice.backend == Backend::automatic
                             ? ": automatic takes hardware only, --backend gpu also software"
                             : ""));
    }
    if (!context)
        return std::make_unique<EmbreeTracer>(scene);
    if (raster)
        return std::make_unique<GlRasterizer>(std::move(context), scene, choice.raster_resolution);
    return std::make_unique<GlTracer>(std::move(context), scene);
}

} // namespace prt

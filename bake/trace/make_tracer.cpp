#include "prt/make_tracer.h"

#include "prt/embree_tracer.h"
#include "prt/gl_rasterizer.h"
#include "prt/gl_tracer.h"
#include "prt/support/error.h"

namespace prt {

std::unique_ptr<Tracer> make_tracer(const Scene& scene, const RayScene& rays, const Surfaces& surfaces,
                                    const std::vector<Texture>& textures, const BakeOptions& options) {
    const bool raster = options.method == BakeMethod::raster;
    std::unique_ptr<GlContext> context;
    if (options.backend != Backend::cpu) {
        std::string why;
        context =
            GlContext::create(options.backend == Backend::gpu ? GlDevice::any : GlDevice::hardware, &why);
        if (!context && (options.backend == Backend::gpu || raster))
            throw Error("there is no OpenGL 4.5 to bake on (" + why + ")" +
                        (options.backend == Backend::automatic
                             ? ": automatic takes hardware only, --backend gpu also software"
                             : ""));
    }
    if (!context)
        return std::make_unique<EmbreeTracer>(rays, options.threads, &surfaces);
    if (raster)
        return std::make_unique<GlRasterizer>(std::move(context), scene, rays, surfaces, textures,
                                              options.raster_resolution, options.threads);
    return std::make_unique<GlTracer>(std::move(context), scene, rays, surfaces, textures, options.threads);
}

} // namespace prt

// Chooses the tracer.

#include "bake/tracers/make_tracer.h"

#include "bake/raster/gl_rasterizer.h"
#include "bake/trace/embree_tracer.h"
#include "bake/trace_gpu/vulkan_tracer.h"
#include "bake/tracers/fallback_tracer.h"
#include "bake/tracers/falloff_tracer.h"
#include "prt/core/error.h"

namespace prt {
namespace {

std::unique_ptr<Tracer> make_ray_tracer(const TraceScene& scene, const TracerChoice& choice);

std::unique_ptr<Tracer> make_rasterizer(const TraceScene& scene, const TracerChoice& choice) {
    const bool any = choice.backend == Backend::gpu;
    std::string why;
    std::unique_ptr<GlContext> context = GlContext::create(any ? GlDevice::any : GlDevice::hardware, &why);
    if (!context)
        throw Error("--method raster needs OpenGL 4.5, which is not available (" + why + ")" +
                    (any ? "" : "; --device auto accepts hardware only, --device gpu also software"));
    return std::make_unique<GlRasterizer>(
        std::move(context), scene, choice.raster_resolution,
        [&scene, traversal = choice.traversal] { return make_ray_tracer(scene, {.traversal = traversal}); });
}

/// Throws `Error` if there is no such device, and if the scene does not fit into its memory.
std::unique_ptr<Tracer> make_vulkan_tracer(const TraceScene& scene, const VulkanChoice& choice) {
    return with_vulkan_errors([&] { return std::make_unique<VulkanTracer>(scene, choice); });
}

std::unique_ptr<Tracer> make_ray_tracer(const TraceScene& scene, const TracerChoice& choice) {
    if (choice.backend == Backend::cpu || (choice.backend == Backend::automatic && !may_have_hardware()))
        return std::make_unique<EmbreeTracer>(scene);
    if (choice.backend == Backend::gpu)
        return make_vulkan_tracer(scene, {.device = choice.gpu, .traversal = choice.traversal});
    try {
        return std::make_unique<FallbackTracer>(
            make_vulkan_tracer(scene, {.hardware_only = true, .traversal = choice.traversal}), scene);
    } catch (const GpuFailure& failure) { // not enough memory for the scene
        return std::make_unique<FallbackTracer>(std::make_unique<EmbreeTracer>(scene), scene,
                                                std::string("(") + failure.what() + ") ");
    } catch (const Error&) { // no device
        return std::make_unique<EmbreeTracer>(scene);
    }
}

} // namespace

std::unique_ptr<Tracer> make_tracer(const TraceScene& scene, const TracerChoice& choice) {
    if (choice.method == BakeMethod::raster && choice.backend != Backend::cpu)
        return make_rasterizer(scene, choice);
    std::unique_ptr<Tracer> tracer = make_ray_tracer(scene, choice);
    if (choice.falloff.blocks_everywhere())
        return tracer;
    return std::make_unique<FalloffTracer>(std::move(tracer), scene, choice.falloff);
}

} // namespace prt

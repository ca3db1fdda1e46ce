#pragma once

#include "prt/gl_context.h"
#include "prt/ray_scene.h"
#include "prt/surfaces.h"
#include "prt/tracer.h"

#include <memory>

namespace prt {

/// Direct transfer from orthographic depth maps: S. Hill, "Hardware Accelerating Art Production", Gamasutra
/// 2004. For each of `rays` directions over the sphere the scene is drawn once, and every receiver compares
/// its depth; blended surfaces are peeled layer by layer. Weights are normalised per receiver. No hits.
class GlRasterizer final : public Tracer {
public:
    GlRasterizer(std::unique_ptr<GlContext> context, const Scene& scene, const RayScene& rays,
                 const Surfaces& surfaces, const std::vector<Texture>& textures, int resolution,
                 int threads = 0);
    ~GlRasterizer() override;
    std::string backend() const override { return "gpu"; }
    std::string method() const override { return "raster"; }
    std::string device() const override;
    /// All at once: the maps are drawn once for them.
    std::size_t batch_size(const TraceOptions& options) const override;
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {}) override;

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace prt

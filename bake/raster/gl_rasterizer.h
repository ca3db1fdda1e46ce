#pragma once

// Tracer on the GPU by depth maps.

#include "bake/raster/depth_maps.h"
#include "bake/raster/raster_scene.h"
#include "bake/scene/trace_scene.h"
#include "bake/trace/tracer.h"
#include "prt/gl/gl_context.h"

#include <functional>
#include <map>
#include <memory>
#include <utility>

namespace prt {

/// Direct transfer from orthographic depth maps: draws the scene once for each of `rays` directions over the
/// sphere; every receiver compares its depth. Blended surfaces are peeled layer by layer. Weights are
/// normalised per receiver. A separate tracer of rays reports hits and the light of lamps.
class GlRasterizer final : public Tracer {
public:
    using MakeRays = std::function<std::unique_ptr<Tracer>()>;

    /// Keeps a reference to `scene`; takes ownership of `context`, which stays current. Calls `make_rays`
    /// when it needs rays for the first time. Throws `Error` if the scene or a map does not fit the device.
    GlRasterizer(std::unique_ptr<GlContext> context, const TraceScene& scene, int resolution,
                 MakeRays make_rays);
    Backend backend() const override { return Backend::gpu; }
    BakeMethod method() const override { return BakeMethod::raster; }
    Tracer& rays() override;
    std::string device() const override;
    /// Returns the number of all receivers: the maps are drawn once for all of them.
    std::size_t batch_size(const TraceOptions& options) const override;
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
               const Progress& progress = {}) override;
    LampLight lamp_light(const LampTask& task, const Progress& progress) override;
    std::unique_ptr<GatherProduct> gather_product(const GatherOperator& gather) override;

private:
    class Batch;

    const GlObject& program(int order, bool peel);
    void trace_hits(const Receivers& receivers, std::span<const std::uint32_t> indices,
                    const TraceOptions& options, const HitSink& sink, const Progress& progress);
    void look_up(std::span<const glm::vec3> directions, int order, std::size_t receivers);
    void dispatch(const GlObject& shader, std::size_t receivers, std::size_t directions) const;

    std::unique_ptr<GlContext> context_;
    const TraceScene& scene_;
    MakeRays make_rays_;
    std::unique_ptr<Tracer> rays_; ///< null until it is needed
    RasterScene raster_scene_;
    DepthMaps maps_;
    std::map<std::pair<int, bool>, GlObject> programs_; ///< by order, and by whether they are for peeling
};

} // namespace prt

#pragma once

// The GPU baker: rays and depth maps in OpenGL 4.5.

#include "prt/gl_context.h"
#include "prt/trace_scene.h"
#include "prt/tracer.h"

#include <memory>

namespace prt {

/// Traces in a compute shader, through a wide quantised hierarchy. The same samples as EmbreeTracer. Work
/// goes to the device in pieces of about a tenth of a second, by the speed that was measured, and of so many
/// hits as `hit_bytes` hold.
class GlTracer final : public Tracer {
public:
    /// Keeps a reference to `scene` (for offsets off the surface); takes `context`, which stays current.
    /// Throws `Error` when the scene does not fit the device.
    GlTracer(std::unique_ptr<GlContext> context, const TraceScene& scene, std::size_t hit_bytes = 96 << 20);
    ~GlTracer() override;
    Backend backend() const override { return Backend::gpu; }
    std::string device() const override;
    std::size_t batch_size(const TraceOptions& options) const override;
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
               const Progress& progress = {}) override;
    /// Pieces that were traced again since their hits did not fit: only blended surfaces can make some, the
    /// first time that rays meet more of them than before.
    std::size_t traced_again() const;

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Direct transfer from orthographic depth maps: S. Hill, "Hardware Accelerating Art Production", Gamasutra
/// 2004. For each of `rays` directions over the sphere the scene is drawn once, and every receiver compares
/// its depth; blended surfaces are peeled layer by layer. Weights are normalised per receiver. No hits.
class GlRasterizer final : public Tracer {
public:
    GlRasterizer(std::unique_ptr<GlContext> context, const TraceScene& scene, int resolution);
    ~GlRasterizer() override;
    Backend backend() const override { return Backend::gpu; }
    BakeMethod method() const override { return BakeMethod::raster; }
    bool notes_hits() const override { return false; }
    std::string device() const override;
    /// All at once: the maps are drawn once for them.
    std::size_t batch_size(const TraceOptions& options) const override;
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
               const Progress& progress = {}) override;

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace prt

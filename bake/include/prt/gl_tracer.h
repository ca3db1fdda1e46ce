#pragma once

#include "prt/gl_context.h"
#include "prt/ray_scene.h"
#include "prt/surfaces.h"
#include "prt/tracer.h"

#include <memory>

namespace prt {

/// Traces in a compute shader, through a wide quantised hierarchy. The same samples as EmbreeTracer. Work
/// goes to the device in pieces of about a tenth of a second, by the speed that was measured, and of so many
/// hits as `hit_bytes` hold.
class GlTracer final : public Tracer {
public:
    /// Keeps references to `rays` (for offsets off the surface) and `surfaces`; takes `context`, which stays
    /// current. Throws `Error` when the scene does not fit the device.
    GlTracer(std::unique_ptr<GlContext> context, const Scene& scene, const RayScene& rays,
             const Surfaces& surfaces, const std::vector<Texture>& textures, int threads = 0,
             std::size_t hit_bytes = 96 << 20);
    ~GlTracer() override;
    std::string backend() const override { return "gpu"; }
    std::string device() const override;
    std::size_t batch_size(const TraceOptions& options) const override;
    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {}) override;
    /// Pieces that were traced again since their hits did not fit: only blended surfaces can make some, the
    /// first time that rays meet more of them than before.
    std::size_t traced_again() const;

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace prt

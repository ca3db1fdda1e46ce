#pragma once

#include "prt/ray_scene.h"
#include "prt/tracer.h"

namespace prt {

/// Traces on the CPU. Results do not depend on the number of threads.
class EmbreeTracer final : public Tracer {
public:
    /// Keeps a reference to `scene`. `threads` 0: all.
    explicit EmbreeTracer(const RayScene& scene, int threads = 0) : scene_(scene), threads_(threads) {}
    std::string backend() const override { return "cpu"; }
    std::size_t batch_size(const DirectOptions& options) const override;
    void direct_transfer(const Receivers& receivers, std::span<const std::uint32_t> indices,
                         const DirectOptions& options, std::span<float> vectors) override;

private:
    const RayScene& scene_;
    int threads_;
};

} // namespace prt

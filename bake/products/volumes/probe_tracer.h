#pragma once

// Computes incident light at positions in free space, with the rays of any tracer.

#include "bake/pipeline/bounce_sources.h"
#include "bake/plan/plan.h"
#include "bake/trace/lamp_rays.h"
#include "bake/trace/sample_sequence.h"
#include "bake/trace/tracer.h"
#include "prt/core/transfer_volume.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

class OuterSums;

/// Layout of a coefficient of incident light: the layouts of the sky and of lamps one after another.
struct IncidentLayout {
    int order = 3;      ///< order of incident light
    TransferLayout sky; ///< terms `direct`, and `indirect` if light bounces
    /// Coefficient k is the light of lamp k; has no terms if there are no lamps.
    TransferLayout lamps;

    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(order)); }
    std::size_t direct() const { return static_cast<std::size_t>(coefficient_count(sky.order)); }
    /// Numbers per coefficient.
    std::size_t numbers() const { return sky.dimension() + (lamps.terms.empty() ? 0 : lamps.dimension()); }
};

/// Light and visibility at a position.
struct ProbeView {
    /// [coefficients][numbers] incident light of the sky, and of lamps.
    std::span<const float> vectors;
    float backs = 0; ///< share of rays that end at back faces without light
    /// [-x, +x, -y, ..] visibility distances from the corner of the cell, metres, up to kVisibilityCells
    /// cells.
    std::array<float, 6> distances{};
};

/// Position and size of a probe in the grid.
struct ProbeCell {
    glm::vec3 corner; ///< corner next to which the probe is measured, metres
    float width;      ///< width of the cells around it, metres
};

/// Traces incident light at positions.
class ProbeTracer {
public:
    /// Keeps references to `plan` and `tracer`. Multiplies `sources` by the reflectance.
    ProbeTracer(const BakePlan& plan, Tracer& tracer, BounceSources sources, int order);

    const IncidentLayout& layout() const { return layout_; }
    std::size_t rays() const { return rays_; }

    struct Task {
        std::span<const glm::vec3> positions;
        /// [positions] cells of probes, for visibility distances; empty: they are not needed.
        std::span<const ProbeCell> cells = {};
        int rays = 1024; ///< approximate number of rays per position
        std::uint64_t seed = 0;
    };
    /// Calls `take` for each position, from several threads.
    void trace(const Task& task, const Progress& progress,
               const std::function<void(std::size_t position, const ProbeView& seen)>& take);

private:
    struct Space;
    void trace_batch(const Task& task, std::size_t begin, std::size_t end,
                     const std::function<void(std::size_t, const ProbeView&)>& take);
    void see(const Task& task, std::size_t position, std::span<const std::vector<Hit>> hits,
             Space& space) const;
    /// Evaluates the basis in unit direction `d`; returns the solid angle that a ray represents.
    float look(const glm::vec3& d, Space& space) const;
    void add_direction(float weight, const Space& space, OuterSums& sums) const;
    void add_hit(const Hit& hit, const Task& task, std::size_t position, Space& space) const;
    void add_rays(const Task& task, std::size_t position, bool mostly_open, Space& space) const;
    void add_reflected(const Hit& hit, float weight, Space& space) const;
    void mix_reflected(const Hit& hit, std::span<float> to) const;
    std::size_t add_lamps(const Task& task, std::size_t position, Space& space) const;

    const BakePlan& plan_;
    Tracer& tracer_;
    IncidentLayout layout_;
    int rays_along_ = 1; ///< rays along each of the six axes
    SobolChunk whole_, last_;
    std::vector<glm::vec3> reflectance_;
    std::vector<float> sky_, lamps_; ///< exit light of all receivers, reflected if each receiver has one
                                     ///< reflectance
    std::vector<ShiningTriangles> shining_;
    std::size_t rays_ = 0;
};

} // namespace prt

#pragma once

// What comes in at places in free space, by the rays of any tracer.

#include "bounced_sources.h"
#include "lamps/lamp_rays.h"
#include "plan.h"
#include "prt/tracer.h"
#include "prt/transfer_volume.h"
#include "trace/sample_sequence.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

class OuterSums;

/// Numbers of a coefficient of incident light, one layout behind the other, and its bands.
struct IncidentLayout {
    int order = 3;      ///< of incident light
    TransferLayout sky; ///< `direct`, and `indirect` where light bounces
    /// Coefficient k is the light of lamp k; of no parts where there are no lamps.
    TransferLayout lamps;

    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(order)); }
    std::size_t direct() const { return static_cast<std::size_t>(coefficient_count(sky.order)); }
    /// Of a coefficient.
    std::size_t numbers() const { return sky.dimension() + (lamps.parts.empty() ? 0 : lamps.dimension()); }
};

/// What a place sees.
struct PlaceSeen {
    /// [coefficients][numbers]: incident light by the sky, and by lamps.
    std::span<const float> vectors;
    float backs = 0; ///< share of its rays that end at the back of what has no light there
    /// [-x, +x, -y, ..]: how far the corner of its cell sees, metres, up to kSightCells cells.
    std::array<float, 6> distances{};
};

/// Where a probe stands for the grid.
struct ProbeCell {
    glm::vec3 corner; ///< that it is measured beside, metres
    float width;      ///< of the cells around it, metres
};

class ProbeTracer {
public:
    /// Keeps references to `plan` and `tracer`; reflects `sources`.
    ProbeTracer(const BakePlan& plan, Tracer& tracer, BouncedSources sources, int order);

    const IncidentLayout& layout() const { return layout_; }
    std::size_t rays() const { return rays_; }

    struct Task {
        std::span<const glm::vec3> places;
        /// [places] cells of probes, for how far they see; empty: that is not asked.
        std::span<const ProbeCell> cells = {};
        int rays = 1024; ///< from each place, about
        std::uint64_t seed = 0;
    };
    /// Calls `take` for each of the places, from several threads.
    void trace(const Task& task, const Progress& progress,
               const std::function<void(std::size_t place, const PlaceSeen& seen)>& take);

private:
    struct Space;
    void trace_batch(const Task& task, std::size_t begin, std::size_t end,
                     const std::function<void(std::size_t, const PlaceSeen&)>& take);
    void see(const Task& task, std::size_t place, std::span<const std::vector<Hit>> hits, Space& space) const;
    /// Evaluates the basis in unit `d`; returns the solid angle that a ray stands for.
    float look(const glm::vec3& d, Space& space) const;
    void add_direction(float weight, const Space& space, OuterSums& sums) const;
    void add_hit(const Hit& hit, const Task& task, std::size_t place, Space& space) const;
    void add_rays(const Task& task, std::size_t place, bool mostly_open, Space& space) const;
    void add_reflected(const Hit& hit, float weight, Space& space) const;
    void mix_reflected(const Hit& hit, std::span<float> to) const;
    std::size_t add_lamps(const Task& task, std::size_t place, Space& space) const;

    const BakePlan& plan_;
    Tracer& tracer_;
    IncidentLayout layout_;
    int rays_along_ = 1; ///< in each of the six directions
    SobolChunk whole_, last_;
    std::vector<glm::vec3> reflectance_;
    std::vector<float> sky_, lamps_; ///< exit light of all receivers, reflected where that is theirs alone
    std::vector<ShiningTriangles> shining_;
    std::size_t rays_ = 0;
};

} // namespace prt

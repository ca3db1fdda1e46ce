#pragma once

// Light that leaves media, for texels on them.

#include "bake/pipeline/bounce_sources.h"
#include "bake/plan/plan.h"
#include "bake/trace/tracer.h"
#include "prt/core/progress.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Measures the light that arrives at evenly spaced vertices of media, and scatters it to points on them
/// (docs/math.md, section 18).
class MediaLight {
public:
    /// Splits edges of media that are longer than `spacing`, metres. `plan`: plan of the scene with the
    /// texels, to which a reference is kept. `traced`, `lit`: the surfaces that rays hit, and their light.
    /// `media`: [materials of the scene].
    MediaLight(const BakePlan& plan, DetailedPlan& traced, const BounceSources& lit, const Media& media,
               double spacing, Tracer& tracer, const Progress& progress);
    MediaLight(const MediaLight&) = delete;

    /// Returns the number of bodies: one for each medium of each node.
    std::size_t bodies() const { return plan_.diffusion.size(); }
    /// Returns the body that a triangle of the scene is part of; no value for triangles without a medium.
    std::optional<std::size_t> body_of(std::uint32_t triangle) const {
        return body_of_[surfaces_.primitive(triangle)];
    }

    struct Exit {
        std::vector<float> sky;   ///< [positions][channels][order²] of the plan, direct and bounced
        std::vector<float> lamps; ///< [positions][channels][coefficients]: coefficient k is lamp k
    };
    /// Returns the light that leaves a body at `positions` on it.
    Exit exit(std::size_t body, std::span<const glm::dvec3> positions) const;

    /// Returns the mean over media of the first coefficient of direct light that arrives.
    float visible() const { return visible_; }
    std::size_t rays() const { return rays_; }

private:
    const Surfaces& surfaces_;
    std::vector<std::optional<std::size_t>> body_of_; ///< [primitives]
    BakeOptions options_;
    const Scene scene_; ///< the media, with short edges
    const TraceScene own_;
    const BakePlan plan_;
    Transfer sky_, lamps_; ///< light that arrives at the vertices
    float visible_ = 0;
    std::size_t rays_ = 0;
};

} // namespace prt

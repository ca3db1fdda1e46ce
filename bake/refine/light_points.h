#pragma once

// Points that stay at their position on a surface when its triangles are split, and the light at them.

#include "bake/refine/bisection.h"
#include "bake/surface_fit/surface_samples.h"
#include "bake/trace/tracer.h"
#include "prt/bake/bake.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// A mesh over which light is interpolated, with front sides only.
struct LitMesh {
    /// Keeps references. `kept`: [primitives] true: triangles of the primitive have an area of 0. `detail`:
    /// surface on which the points are measured; null: the mesh.
    LitMesh(const Scene& scene, const std::vector<bool>& kept, const DetailedSurface* detail);
    LitMesh(const LitMesh&) = delete;

    const std::vector<Texture> textures; ///< always empty
    const Surfaces surfaces;
    const TransportReceivers receivers;
    std::vector<double> areas; ///< [triangles] m²; zero if a corner has no normal and therefore
                               ///< stays dark, and in kept primitives
};

/// Direct light at points, from two independent scrambles of rays: their product has no noise. A random half
/// of the points of every triangle is one fold, the other half the other: a fit to one fold is tested against
/// the other. Light is never traced twice at a point.
class LightPoints {
public:
    /// Keeps references. `scene`: surfaces that rays hit; `tolerance`: significant relative error; the number
    /// of rays is high enough that noise does not hide it.
    LightPoints(const TraceScene& scene, Tracer& tracer, const BakeOptions& options, double tolerance);

    /// Adds points until each triangle of `mesh` has enough.
    void spread(const LitMesh& mesh, const Progress& progress);
    /// Moves points to the parts (`parts`) into which their triangles were split.
    void move(std::span<const Part> parts);

    /// Requests more points in triangles with few points. Returns whether it found any.
    bool look_closer();

    std::size_t size() const { return points_.size(); }
    const SamplePosition& position(std::size_t point) const { return points_[point].position; }
    std::size_t fold(std::size_t point) const { return points_[point].fold; }
    bool sealed(std::size_t point) const { return points_[point].sealed; }
    /// Light from both scrambles, one after the other: [2][order²].
    std::span<const float> light(std::size_t point) const {
        return std::span(light_).subspan(point * stride(), stride());
    }
    std::size_t stride() const { return 2 * coefficients_; }
    int rays_per_scramble() const { return rays_; }
    std::size_t rays() const { return rays_traced_; } ///< all traced rays

private:
    struct Point {
        SamplePosition position;
        std::uint8_t fold;
        bool sealed; ///< inside geometry, where no light arrives: provides no information
    };
    using Counts = std::array<std::size_t, 2>; ///< counts of both folds

    std::size_t missing(std::uint32_t triangle, double area, const Counts& counts) const;
    void add(const LitMesh& mesh, std::uint32_t triangle, Counts counts, SurfaceSamples& added);
    int choose_rays(const SurfaceSamples& added, const Progress& progress);
    std::vector<float> trace(const Receivers& receivers, int rays, const Progress& progress);

    const TraceScene& scene_;
    Tracer& tracer_;
    const BakeOptions& options_;
    const double tolerance_;
    const std::size_t coefficients_;
    std::vector<Point> points_;
    std::vector<float> light_;       ///< [points][2][order²]
    std::vector<std::size_t> least_; ///< [triangles] minimum number of points of each fold
    double per_area_ = 0;            ///< points per area
    int rays_ = 0;                   ///< rays per point and scramble; 0: not known yet
    std::uint32_t round_ = 0;
    std::size_t rays_traced_ = 0;
};

} // namespace prt

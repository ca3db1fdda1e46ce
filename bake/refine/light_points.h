#pragma once

// Points that stay on a surface while its triangles are split, and the light at them.

#include "prt/bake.h"
#include "prt/tracer.h"
#include "refine/bisection.h"
#include "surface/surface_samples.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// A mesh as light is interpolated over it: fronts alone.
struct LitMesh {
    /// Keeps a reference to `scene`.
    explicit LitMesh(const Scene& scene);
    LitMesh(const LitMesh&) = delete;

    const std::vector<Texture> textures; ///< none
    const Surfaces surfaces;
    const TransportReceivers receivers;
    std::vector<double> areas; ///< [triangles] m²; zero where a corner has no normal, and stays dark
};

/// Direct light at points, each by two independent scrambles of its rays: their product has no noise. Half
/// of the points of every triangle, chosen by chance, are one fold, the others the other: what is fitted to
/// one is judged by the other. Where light has been traced once it is not traced again.
class LightPoints {
public:
    /// Keeps references. `tolerance`: relative error that matters; rays are so many that noise hides none.
    LightPoints(const TraceScene& scene, Tracer& tracer, const BakeOptions& options, double tolerance);

    /// Adds points until each triangle of `mesh` has enough.
    void spread(const LitMesh& mesh, const Progress& progress);
    /// Takes points to the parts that their triangles were split in.
    void move(std::span<const Part> parts);

    /// Asks for more points, where there are few; whether there are any.
    bool look_closer();

    std::size_t size() const { return points_.size(); }
    const SamplePlace& place(std::size_t point) const { return points_[point].place; }
    std::size_t fold(std::size_t point) const { return points_[point].fold; }
    bool sealed(std::size_t point) const { return points_[point].sealed; }
    /// By both scrambles, one behind the other: [2][order²].
    std::span<const float> light(std::size_t point) const {
        return std::span(light_).subspan(point * stride(), stride());
    }
    std::size_t stride() const { return 2 * coefficients_; }
    int rays_per_scramble() const { return rays_; }
    std::size_t rays() const { return rays_traced_; } ///< all so far

private:
    struct Point {
        SamplePlace place;
        std::uint8_t fold;
        bool sealed; ///< inside geometry, where no light reaches: it tells nothing
    };
    using Counts = std::array<std::size_t, 2>; ///< of both folds

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
    std::vector<std::size_t> least_; ///< [triangles] points of each fold
    double per_area_ = 0;            ///< points
    int rays_ = 0;                   ///< of a point and scramble; 0: not known yet
    std::uint32_t round_ = 0;
    std::size_t rays_traced_ = 0;
};

} // namespace prt

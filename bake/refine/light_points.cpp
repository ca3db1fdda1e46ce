// Spreads points over triangles, traces them, and moves them to the new triangles after a split.

#include "bake/refine/light_points.h"

#include "bake/trace/sample_sequence.h"
#include "bake/trace/scrambles.h"
#include "bake/trace/sealed.h"
#include "bake/trace/trace_receivers.h"
#include "prt/core/sh_basis.h"

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prt {
namespace {

/// Minimum number of points: of each fold, so that a fit to either fold has data in every triangle, for
/// triangles that nothing has marked for splitting (the majority in a fine mesh), and for parts of split
/// triangles and for a closer look; and of the whole surface, to find errors inside large triangles.
constexpr std::size_t kOfFold = 1, kOfFoldInParts = 2, kOfSurface = 4096;
/// Number of points that measure the noise of rays, and their rays.
constexpr std::size_t kFirstPoints = 256;
constexpr int kFirstRays = 256, kFewestRaysOfPoint = 64, kMaxRaysOfPoint = 16384;
/// Noise of a point from one scramble, relative to the significant error. Triangles that noise makes look
/// good are not traced again: the plain room (benchmarks.md) baked with 4 096 rays had 2.03 % where 1.82 %
/// were estimated, but with a value of 3 it had 2.49 % instead of 1.95 %.
constexpr double kNoiseOfPoint = 1.5;

/// Depth of `at` inside a triangle, negative outside, and its barycentric coordinates.
struct Found {
    double depth;
    glm::dvec2 uv;
};

Found find(const std::array<glm::dvec2, 3>& corners, const glm::dvec2& at) {
    // Corners are exact fractions, and a part of a triangle has an area.
    const glm::dvec2 uv =
        glm::inverse(glm::dmat2(corners[1] - corners[0], corners[2] - corners[0])) * (at - corners[0]);
    return {std::min({uv.x, uv.y, 1 - uv.x - uv.y}), uv};
}

/// Moves a point that rounding has put outside of the triangle to its border.
glm::vec2 clamped(glm::dvec2 uv) {
    uv = glm::max(uv, glm::dvec2(0));
    return glm::vec2(uv / std::max(1.0, uv.x + uv.y));
}

} // namespace

LitMesh::LitMesh(const Scene& scene, const std::vector<bool>& kept, const DetailedSurface* detail)
    : surfaces(scene, textures), receivers(measured_on(detail, without_back_sides(vertex_receivers(scene)))) {
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const std::vector<glm::vec3>& at = receivers.receivers.positions;
        const glm::uvec3& c = surfaces.corners(t);
        const glm::uvec3 lit = corner_receivers(surfaces, receivers, t, false);
        const glm::dvec3 a(at[c.x]);
        const bool dark = kept[surfaces.primitive(t)] || glm::any(glm::equal(lit, glm::uvec3(kNoReceiver)));
        areas.push_back(
            dark ? 0 : 0.5 * glm::length(glm::cross(glm::dvec3(at[c.y]) - a, glm::dvec3(at[c.z]) - a)));
    }
}

LightPoints::LightPoints(const TraceScene& scene, Tracer& tracer, const BakeOptions& options,
                         double tolerance)
    : scene_(scene), tracer_(tracer), options_(options), tolerance_(tolerance),
      coefficients_(static_cast<std::size_t>(coefficient_count(options.order))) {}

std::size_t LightPoints::missing(std::uint32_t triangle, double area, const Counts& counts) const {
    const std::size_t least = least_[triangle], has = counts[0] + counts[1],
                      wanted = std::max(2 * least, static_cast<std::size_t>(area * per_area_));
    return area == 0 ? 0
                     : std::max(wanted - std::min(wanted, has),
                                least - std::min({least, counts[0], counts[1]})); // even if one triangle has
                                                                                  // many
}

void LightPoints::add(const LitMesh& mesh, std::uint32_t triangle, Counts counts, SurfaceSamples& added) {
    const std::uint32_t hash = receiver_seed(triangle, options_.seed + round_ + 7 * kSecondScramble);
    const std::size_t count = missing(triangle, mesh.areas[triangle], counts);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t fold = counts[0] == counts[1] ? (hash + i) % 2 : counts[1] < counts[0] ? 1 : 0;
        ++counts[fold];
        const SamplePosition position{triangle, false, even_point(hash, i)};
        append_sample(added, mesh.surfaces, mesh.receivers, position, 0);
        points_.push_back({position, static_cast<std::uint8_t>(fold), false});
    }
}

void LightPoints::spread(const LitMesh& mesh, const Progress& progress) {
    if (round_ == 0) {
        const double area = std::accumulate(mesh.areas.begin(), mesh.areas.end(), 0.0);
        per_area_ = area > 0 ? static_cast<double>(kOfSurface) / area : 0;
        least_.assign(mesh.areas.size(), kOfFold);
    }
    std::vector<Counts> counts(mesh.areas.size());
    for (const Point& point : points_)
        ++counts[point.position.triangle][point.fold];
    const std::size_t before = size();
    SurfaceSamples added;
    for (std::uint32_t t = 0; t < counts.size(); ++t)
        add(mesh, t, counts[t], added);
    if (rays_ == 0)
        rays_ = choose_rays(added, progress);
    const std::vector<float> light = trace(added.receivers, rays_, progress);
    std::vector<std::uint32_t> dark;
    for (std::uint32_t p = 0; p < added.size(); ++p)
        if (light[p * stride()] <= 0 && light[p * stride() + coefficients_] <= 0)
            dark.push_back(p);
    const Sealed found =
        find_sealed(tracer_, scene_, added.receivers, std::move(dark), options_.seed, progress.stop);
    rays_traced_ += found.rays;
    light_.insert(light_.end(), light.begin(), light.end());
    for (std::size_t p = 0; p < added.size(); ++p)
        points_[before + p].sealed = found.receivers[p];
    ++round_;
}

bool LightPoints::look_closer() {
    const bool few = std::ranges::count(least_, kOfFold) > 0;
    std::ranges::fill(least_, kOfFoldInParts);
    return few;
}

int LightPoints::choose_rays(const SurfaceSamples& added, const Progress& progress) {
    Receivers some;
    const std::size_t step = std::max<std::size_t>(1, added.size() / kFirstPoints);
    for (std::size_t p = 0; p < added.size(); p += step)
        some.append(added.receivers, p);
    const std::vector<float> light = trace(some, kFirstRays, {{}, progress.stop});
    double noise = 0, norm = 0;
    for (std::size_t p = 0; p < some.size(); ++p) {
        const auto a = std::span(light).subspan(p * stride(), coefficients_),
                   b = std::span(light).subspan(p * stride() + coefficients_, coefficients_);
        noise += squared_distance(a, b) / 2;
        norm += product(a, b);
    }
    if (!(norm > 0 && noise > 0))
        return kFewestRaysOfPoint;
    // The error of a net of n rays falls as n^-0.75 (docs/math.md, section 14).
    const double rays =
        kFirstRays * std::pow(std::sqrt(noise / norm) / (kNoiseOfPoint * tolerance_), 1 / 0.75);
    return static_cast<int>(std::clamp<double>(std::ceil(rays / kFewestRaysOfPoint) * kFewestRaysOfPoint,
                                               kFewestRaysOfPoint, kMaxRaysOfPoint));
}

std::vector<float> LightPoints::trace(const Receivers& receivers, int rays, const Progress& progress) {
    std::vector<float> light(receivers.size() * stride());
    std::vector<std::uint32_t> all(receivers.size());
    std::iota(all.begin(), all.end(), 0u);
    TraceOptions options{.order = options_.order, .rays = rays};
    for (std::size_t half = 0; half < 2; ++half) {
        options.seed = options_.seed + (8 + 2 * round_ + half) * kSecondScramble;
        trace_receivers(
            tracer_, receivers, all, options,
            [&](std::uint32_t p, std::span<const float> vector) {
                std::copy(vector.begin(), vector.end(),
                          light.begin() + static_cast<std::ptrdiff_t>(p * stride() + half * coefficients_));
            },
            progress.range(0.5 * static_cast<double>(half), 0.5 * static_cast<double>(half + 1)));
        rays_traced_ += receivers.size() * static_cast<std::size_t>(rays);
    }
    return light;
}

void LightPoints::move(std::span<const Part> parts) {
    std::vector<std::uint32_t> first; // first part of each original triangle
    std::vector<std::size_t> least;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
        if (parts[i].whole == first.size())
            first.push_back(i);
        const bool is_whole =
            i == first.back() && (i + 1 == parts.size() || parts[i + 1].whole != parts[i].whole);
        least.push_back(is_whole ? least_[parts[i].whole] : kOfFoldInParts);
    }
    first.push_back(static_cast<std::uint32_t>(parts.size()));
    least_ = std::move(least);
    for (Point& point : points_) {
        Found best{-1e30, {}};
        const std::uint32_t whole = point.position.triangle;
        for (std::uint32_t i = first[whole]; i < first[whole + 1]; ++i)
            if (const Found here = find(parts[i].corners, glm::dvec2(point.position.uv));
                here.depth > best.depth) {
                best = here;
                point.position.triangle = i;
            }
        point.position.uv = clamped(best.uv);
    }
}

} // namespace prt

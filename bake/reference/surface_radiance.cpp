// Traces paths from points of the surface. A path that ends in the sky contributes three values: the sky's
// radiance (with light from next-event estimation along the path), the radiance of the sky's bands, and the
// radiance of the suns' bands.

#include "bake/reference/surface_radiance.h"

#include "bake/reference/light_paths.h"
#include "bake/trace/disc_share.h"
#include "bake/trace/each_receiver.h"
#include "prt/bake/bake_options.h"
#include "prt/core/sh.h"
#include "runtime/core/support/stopwatch.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace prt {
namespace {

/// Returns the radiance of each band in a direction with a known basis.
BandRadiance::Bands bands_of(const Light& light, std::span<const float> basis) {
    BandRadiance::Bands bands{};
    for (int l = 0; l < light.order; ++l)
        for (int i = l * l; i < (l + 1) * (l + 1); ++i)
            bands[static_cast<std::size_t>(l)] +=
                basis[static_cast<std::size_t>(i)] * light.coefficients[static_cast<std::size_t>(i)];
    return bands;
}

void add(BandRadiance::Bands& sum, const BandRadiance::Bands& bands, const glm::vec3& factor) {
    for (std::size_t l = 0; l < sum.size(); ++l)
        sum[l] += factor * bands[l];
}

/// Returns the hit of a camera that looks at the front of a point.
SurfaceHit hit_at(const TraceScene& scene, const SurfacePoints& points, std::size_t p) {
    const SurfacePoint point{points.triangles[p], points.uv[p], 0};
    const glm::vec3 anywhere(0);
    return {0, point, met_surface(scene.scene(), scene.rays(), point, anywhere).side, true, false};
}

/// Range of paths in the sequence of a point.
struct PathRange {
    std::uint32_t seed;
    int begin, end;
};

struct PointSum {
    glm::vec3 truth{0};
    BandRadiance bands;
};

void add_paths(const LightPaths& paths, const SurfaceHit& hit, const ReferenceLight& light, PathRange range,
               PointSum& sum) {
    std::array<float, static_cast<std::size_t>(coefficient_count(kMaxOrder))> basis;
    for (int i = range.begin; i < range.end; ++i) {
        PathSamples samples(range.seed, static_cast<std::uint32_t>(i));
        LightPath path;
        const bool escapes = paths.scatter(hit, path, samples) && paths.follow(path, samples);
        sum.truth += path.radiance;
        if (!escapes)
            continue;
        evaluate_sh(kMaxOrder, path.ray.direction, basis);
        const auto bounces = static_cast<std::size_t>(std::min(path.vertices - 1, kCountedBounces));
        add(sum.bands.sky[bounces], bands_of(light.sky_bands, basis), path.throughput);
        if (bounces > 0 && !light.suns.empty())
            add(sum.bands.suns[bounces], bands_of(light.sun_bands, basis), path.throughput);
    }
}

void scale(BandRadiance& radiance, float factor) {
    for (auto* bounces : {&radiance.sky, &radiance.suns})
        for (BandRadiance::Bands& bands : *bounces)
            for (glm::vec3& band : bands)
                band *= factor;
}

/// Direct light of suns at a point.
glm::vec3 sun_light(const TraceScene& scene, const SurfaceHit& hit, std::span<const Sun> suns) {
    constexpr int kSunRays = 64;
    glm::vec3 sum(0);
    for (const Sun& sun : suns) {
        const DiscDirections disc(sun.towards, sun.half_angle, kSunRays);
        const double share = share_of_disc(scene, hit.side.origin(), hit.side.normal, disc, 0,
                                           [](int) { return std::numeric_limits<float>::infinity(); });
        sum += sun.irradiance / std::numbers::pi_v<float> * static_cast<float>(share);
    }
    return sum;
}

/// Sum of all bands and bounces.
glm::vec3 all_of(const BandRadiance& radiance) {
    glm::vec3 sum(0);
    for (const auto* bounces : {&radiance.sky, &radiance.suns})
        for (const BandRadiance::Bands& bands : *bounces)
            sum += std::accumulate(bands.begin(), bands.end(), glm::vec3(0));
    return sum;
}

/// Standard error of the mean product of both halves, relative to their mean square, if they differ only by
/// noise: the larger one of the light and of its bands. Sums contain `paths` paths.
double noise_of(const SurfacePoints& points, const std::array<std::vector<PointSum>, 2>& sums,
                std::span<const glm::vec3> suns, int paths) {
    const double share = 1.0 / paths;
    double of_light = 0, of_bands = 0, norm = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        const glm::dvec3 a(sums[0][p].truth), b(sums[1][p].truth), sun(suns[p]);
        const glm::dvec3 bands(all_of(sums[0][p].bands) - all_of(sums[1][p].bands));
        const auto area = static_cast<double>(points.receivers.areas[p]);
        of_light += area * glm::dot(a - b, a - b) * share * share / 2;
        of_bands += area * glm::dot(bands, bands) * share * share / 2;
        norm += area * glm::dot(share * a + sun, share * b + sun);
    }
    return norm > 0 ? std::max(of_light, of_bands) / norm / std::sqrt(static_cast<double>(points.size())) : 0;
}

} // namespace

BandFactors ReferenceLight::factors(int order) const {
    return dering_factors(truncated(sky_bands, order));
}

Lighting ReferenceLight::lighting(int order, const BandFactors& factors) const {
    Lighting lighting{.sky = with_band_factors(truncated(sky_bands, order), factors), .name = name};
    if (!suns.empty())
        lighting.suns = truncated(sun_bands, order);
    return lighting;
}

SurfaceRadiance::SurfaceRadiance(const TraceScene& scene, const SurfacePoints& points,
                                 const ReferenceLight& light, const SurfaceRadianceOptions& options,
                                 const Progress& progress) {
    const LightPaths paths{scene, {light.seen(), light.all}, {kEndlessBounces, false, false}};
    std::vector<SurfaceHit> hits;
    for (std::size_t p = 0; p < points.size(); ++p) {
        hits.push_back(hit_at(scene, points, p));
        suns_.push_back(sun_light(scene, hits.back(), light.suns));
    }
    std::array<std::vector<PointSum>, 2> sums{std::vector<PointSum>(points.size()),
                                              std::vector<PointSum>(points.size())};
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    const Stopwatch stopwatch;
    int done = 0;
    for (int next = options.paths; done < next;) {
        const auto most = static_cast<double>(std::max(options.paths, options.max_paths));
        for_each_receiver(all, options.threads, progress.range(done / most, next / most),
                          [&](std::uint32_t p) {
                              for (std::size_t h = 0; h < sums.size(); ++h)
                                  add_paths(paths, hits[p], light,
                                            {receiver_seed(p, options.seed + h), done, next}, sums[h][p]);
                          });
        done = next;
        const bool late = options.seconds > 0 && stopwatch.seconds() > options.seconds;
        if (!late && noise_of(points, sums, suns_, done) > options.noise)
            next = std::max(done, std::min(2 * done, options.max_paths));
    }
    for (std::size_t h = 0; h < sums.size(); ++h)
        for (PointSum& sum : sums[h]) {
            scale(sum.bands, 1 / static_cast<float>(done));
            halves_[h].truth.push_back(sum.truth / static_cast<float>(done));
            halves_[h].bands.push_back(sum.bands);
        }
    progress.update(1);
}

std::vector<glm::vec3> SurfaceRadiance::under(const BandTruncation& cut, int half) const {
    const int most = cut.bounces < 0 ? kCountedBounces : std::min(cut.bounces, kCountedBounces);
    std::vector<glm::vec3> radiance;
    for (const BandRadiance& bands : halves_[static_cast<std::size_t>(half)].bands) {
        glm::vec3 sum(0);
        for (std::size_t b = 0; b <= static_cast<std::size_t>(most); ++b)
            for (std::size_t l = 0; l < static_cast<std::size_t>(cut.order); ++l)
                sum += static_cast<float>(cut.factors[l]) * bands.sky[b][l] + bands.suns[b][l];
        radiance.push_back(sum);
    }
    return radiance;
}

} // namespace prt

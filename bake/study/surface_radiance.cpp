// Follows paths from points of the surface. Where one ends in the sky it counts three times: with the
// radiance there (and with what next-event estimation found on its way), with that of the sky's bands, and
// with that of the suns' bands.

#include "prt/surface_radiance.h"

#include "pictures/light_paths.h"
#include "prt/bake.h"
#include "prt/sh.h"
#include "scene/interpolated.h"
#include "trace/disc_share.h"
#include "trace/each_receiver.h"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace prt {
namespace {

/// The radiance of each band in a direction whose basis is known.
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

/// A point as a camera meets it that looks at the front.
SurfaceHit hit_at(const TraceScene& scene, const SurfacePoints& points, std::size_t p) {
    const SurfacePoint point{points.triangles[p], points.uv[p], 0};
    const glm::vec3 anywhere(0);
    return {0, point,
            met_surface(scene.scene(), scene.rays(), point, points.receivers.positions[p], anywhere).side,
            true};
}

struct PointSum {
    glm::vec3 truth{0};
    BandRadiance bands;
};

/// The sum over the paths of a point.
PointSum sum_of_paths(const LightPaths& paths, const SurfaceHit& hit, const MeasuredLight& light, int count,
                      std::uint32_t seed) {
    PointSum sum;
    std::array<float, static_cast<std::size_t>(coefficient_count(kMaxOrder))> basis;
    for (int i = 0; i < count; ++i) {
        PathSamples samples(seed, static_cast<std::uint32_t>(i));
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
    return sum;
}

void scale(BandRadiance& radiance, float factor) {
    for (auto* bounces : {&radiance.sky, &radiance.suns})
        for (BandRadiance::Bands& bands : *bounces)
            for (glm::vec3& band : bands)
                band *= factor;
}

} // namespace

SurfaceRadiance::SurfaceRadiance(const TraceScene& scene, const SurfacePoints& points,
                                 const MeasuredLight& light, const SurfaceRadianceOptions& options,
                                 const Progress& progress)
    : suns_(points.size(), glm::vec3(0)) {
    const LightPaths paths{scene, {light.seen(), light.all}, {kEndlessBounces, false, false}};
    for (Half& half : halves_) {
        half.truth.resize(points.size());
        half.bands.resize(points.size());
    }
    constexpr int kSunRays = 64;
    std::vector<DiscDirections> discs;
    for (const SunDisc& sun : light.suns)
        discs.emplace_back(sun.towards, sun.half_angle, kSunRays);
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    for_each_receiver(all, options.threads, progress, [&](std::uint32_t p) {
        const SurfaceHit hit = hit_at(scene, points, p);
        const float share = 1 / static_cast<float>(options.paths);
        for (std::size_t h = 0; h < halves_.size(); ++h) {
            PointSum sum = sum_of_paths(paths, hit, light, options.paths, receiver_seed(p, options.seed + h));
            halves_[h].truth[p] = sum.truth * share;
            scale(sum.bands, share);
            halves_[h].bands[p] = sum.bands;
        }
        for (std::size_t s = 0; s < discs.size(); ++s)
            suns_[p] +=
                light.suns[s].irradiance / std::numbers::pi_v<float> *
                static_cast<float>(share_of_disc(scene, hit.side.origin(), hit.side.normal, discs[s], 0,
                                                 [](int) { return std::numeric_limits<float>::infinity(); }));
    });
}

std::vector<glm::vec3> SurfaceRadiance::under(const BandCut& cut, int half) const {
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

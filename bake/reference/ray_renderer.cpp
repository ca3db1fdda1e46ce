// Draws pictures with primary rays, and with rays from visible surfaces to the suns.

#include "bake/reference/ray_renderer.h"

#include "bake/reference/sun_light.h"
#include "runtime/core/support/parallel.h"
#include "runtime/render/lightmap_lookup.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>
#include <optional>

namespace prt {
namespace {

glm::vec3 at_corners(const Picture& picture, const SeenSurface& surface) {
    const glm::vec2& uv = surface.barycentrics;
    return picture.radiance[surface.receivers.x] * (1 - uv.x - uv.y) +
           picture.radiance[surface.receivers.y] * uv.x + picture.radiance[surface.receivers.z] * uv.y;
}

class RayRenderer {
public:
    RayRenderer(const Picture& picture, const TraceScene& scene, int sun_rays)
        : picture_(picture),
          rays_(picture, scene.rays(), picture.width * picture.samples, picture.height * picture.samples),
          // The same number for each sample of a pixel.
          suns_(picture, scene, (sun_rays + samples() - 1) / samples() * samples()) {
        if (picture.in_shader.lightmaps.layout)
            lightmaps_.emplace(*picture.scene, *picture.in_shader.lightmaps.layout);
    }

    int columns() const { return rays_.columns(); }
    int rows() const { return rays_.rows(); }

    glm::vec3 sample(int x, int y) const {
        glm::vec3 sum(0);
        const float left = rays_.walk(x, y, [&](const SeenSurface& surface, float transmittance) {
            const glm::vec3 radiance = glm::max(exit_radiance_at(surface), glm::vec3(0));
            sum += transmittance * surface.base.a * (radiance * glm::vec3(surface.base) + surface.emission);
            if (!suns_.none())
                sum += transmittance * surface.base.a *
                       suns_.radiance(surface, {rays_.direction(x, y), rays_.solid_angle(x, y)},
                                      disc_sample(x, y));
        });
        return left > 0 ? sum + left * background_radiance(picture_, glm::normalize(rays_.direction(x, y)))
                        : sum;
    }

private:
    glm::vec3 exit_radiance_at(const SeenSurface& surface) const {
        return lightmaps_ && lightmaps_->has_texels(surface.triangle)
                   ? lightmaps_->look_up(surface.triangle, surface.barycentrics,
                                         picture_.in_shader.lightmaps.radiance)
                   : at_corners(picture_, surface);
    }

    int samples() const { return picture_.samples * picture_.samples; }

    /// The samples of a pixel share the points of the discs. The discs are rotated per pixel by interleaved
    /// gradient noise: adjacent pixels differ evenly (J. Jimenez, "Next Generation Post Processing in Call of
    /// Duty: Advanced Warfare", SIGGRAPH 2014 courses).
    DiscSample disc_sample(int x, int y) const {
        const int across = picture_.samples;
        const int column = x / across, row = y / across; // column and row of the pixel
        const double gradient = 0.06711056 * column + 0.00583715 * row;
        const double noise = 52.9829189 * (gradient - std::floor(gradient));
        return {y % across * across + x % across, samples(), 2 * std::numbers::pi * noise};
    }

    const Picture& picture_;
    PrimaryRays rays_;
    std::optional<LightmapLookup> lightmaps_;
    SunLight suns_;
};

} // namespace

Image render_rays(const Picture& picture, const TraceScene& scene, const RayPictureOptions& options) {
    const RayRenderer renderer(picture, scene, options.sun_rays);
    Image image{renderer.columns(), renderer.rows(), {}};
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    parallel_for(static_cast<std::size_t>(image.height), 4, options.threads,
                 [&](std::size_t begin, std::size_t end) {
                     for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                         for (int x = 0; x < image.width; ++x)
                             image.at(x, y) = renderer.sample(x, y);
                 });
    return image;
}

} // namespace prt

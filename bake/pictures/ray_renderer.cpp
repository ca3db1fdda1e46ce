// Draws pictures with primary rays.

#include "prt/ray_renderer.h"

#include "pictures/primary_rays.h"

#include "prt/support/parallel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace prt {
namespace {

glm::vec3 exit_radiance_at(const Picture& picture, const SeenSurface& surface) {
    const glm::vec2& uv = surface.barycentrics;
    return picture.radiance[surface.receivers.x] * (1 - uv.x - uv.y) +
           picture.radiance[surface.receivers.y] * uv.x + picture.radiance[surface.receivers.z] * uv.y;
}

glm::vec3 pixel(const Picture& picture, const PrimaryRays& rays, int x, int y) {
    glm::vec3 sum(0);
    const float left = rays.walk(x, y, [&](const SeenSurface& surface, float transmittance) {
        const glm::vec3 radiance = glm::max(exit_radiance_at(picture, surface), glm::vec3(0));
        sum += transmittance * surface.base.a * radiance * glm::vec3(surface.base);
    });
    return left > 0 ? sum + left * background_radiance(picture, glm::normalize(rays.direction(x, y))) : sum;
}

} // namespace

Image render_rays(const Picture& picture, const RayScene& ray_scene, int threads) {
    const PrimaryRays rays(picture, ray_scene, picture.width * picture.samples,
                           picture.height * picture.samples);
    Image image{rays.columns(), rays.rows(), {}};
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    parallel_for(static_cast<std::size_t>(image.height), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < image.width; ++x)
                image.at(x, y) = pixel(picture, rays, x, y);
    });
    return image;
}

} // namespace prt

#include "prt/ray_renderer.h"

#include "interpolated.h"

#include "prt/parallel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <optional>

namespace prt {
namespace {

struct Ray {
    glm::vec3 origin, direction;
};

struct Corners {
    glm::vec3 a, b, c;
};

/// Barycentric coordinates (of b and c) where the line through `origin` along `direction` meets the plane of
/// the triangle.
glm::vec2 plane_barycentrics(const Corners& t, const glm::vec3& origin, const glm::vec3& direction) {
    const glm::dvec3 ab(t.b - t.a), ac(t.c - t.a), d(direction), s(origin - t.a);
    const glm::dvec3 p = glm::cross(d, ac), q = glm::cross(s, ab);
    const double determinant = glm::dot(ab, p);
    return {static_cast<float>(glm::dot(s, p) / determinant),
            static_cast<float>(glm::dot(d, q) / determinant)};
}

class RayRenderer {
public:
    RayRenderer(const Picture& picture, const RayScene& ray_scene)
        : picture_(picture), rays_(ray_scene), frame_(camera_frame(picture.camera)),
          width_(picture.width * picture.samples), height_(picture.height * picture.samples) {}

    Image render(int threads) const {
        Image image{width_, height_, {}};
        image.pixels.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
        parallel_for(static_cast<std::size_t>(height_), 4, threads, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                for (int x = 0; x < width_; ++x)
                    image.at(x, y) = pixel(x, y);
        });
        return image;
    }

private:
    glm::vec3 direction(double x, double y) const {
        const double aspect = static_cast<double>(picture_.width) / picture_.height;
        return glm::vec3(frame_.forward +
                         frame_.right * (frame_.half_height * aspect * (2 * (x + 0.5) / width_ - 1)) +
                         frame_.up * (frame_.half_height * (1 - 2 * (y + 0.5) / height_)));
    }

    /// Surfaces along the ray from front to back, until one is opaque.
    glm::vec3 pixel(int x, int y) const {
        const glm::vec3 along = direction(x, y);
        glm::vec3 sum(0);
        float transmittance = 1;
        float from = 0;
        for (;;) {
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            RTCRayHit hit{};
            const glm::vec3& origin = picture_.camera.position;
            hit.ray = {origin.x, origin.y, origin.z,
                       from,     along.x,  along.y,
                       along.z,  0,        std::numeric_limits<float>::infinity(),
                       ~0u,      0,        0};
            hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(rays_.handle(), &context, &hit);
            if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
                return sum + transmittance * background_radiance(picture_, glm::normalize(along));
            const glm::vec4 surface = shade(rays_.triangle(hit.hit.primID), along, x, y);
            sum += transmittance * surface.a * glm::vec3(surface);
            transmittance *= 1 - surface.a;
            if (transmittance <= 0)
                return sum;
            from = std::nextafter(hit.ray.tfar, std::numeric_limits<float>::infinity());
        }
    }

    /// Radiance and coverage of a triangle seen along `along`; coverage 0 where it is culled or cut out.
    glm::vec4 shade(RayScene::Triangle id, const glm::vec3& along, int x, int y) const {
        const Scene& scene = *picture_.scene;
        const Primitive& primitive = scene.primitives[id.primitive];
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        const Material& material = scene.materials[primitive.material];
        const glm::uvec3& t = primitive.triangles[id.triangle];
        const Corners corners{vertices.positions[t.x], vertices.positions[t.y], vertices.positions[t.z]};
        const glm::vec3 normal = glm::cross(corners.b - corners.a, corners.c - corners.a);
        if (!material.double_sided && glm::dot(normal, along) >= 0)
            return glm::vec4(0);

        const glm::vec2 uv = plane_barycentrics(corners, picture_.camera.position, along);
        const glm::uvec3 receivers = t + static_cast<unsigned>(vertices.first_receiver);
        glm::vec3 radiance = picture_.radiance[receivers.x] * (1 - uv.x - uv.y) +
                             picture_.radiance[receivers.y] * uv.x + picture_.radiance[receivers.z] * uv.y;
        radiance = glm::max(radiance, glm::vec3(0));
        if (!picture_.textured)
            return glm::vec4(radiance, 1);
        glm::vec4 base = material.base_color;
        if (!vertices.colors.empty())
            base *= interpolated(vertices.colors, t, uv);
        if (const auto texel = base_color_texel(vertices, material.base_color_texture, corners, t, uv, x, y))
            base *= *texel;
        if (material.alpha_mode == AlphaMode::opaque)
            base.a = 1;
        else if (material.alpha_mode == AlphaMode::mask)
            base.a = base.a < material.alpha_cutoff ? 0.0f : 1.0f;
        return {radiance * glm::vec3(base), std::clamp(base.a, 0.0f, 1.0f)};
    }

    /// Filtered by the footprint of one sample: neighbouring rays meet the triangle's plane, as dFdx and dFdy
    /// do.
    std::optional<glm::vec4> base_color_texel(const VertexArray& vertices, const TextureUse& use,
                                              const Corners& corners, const glm::uvec3& t,
                                              const glm::vec2& uv, int x, int y) const {
        if (use.image < 0 || static_cast<std::size_t>(use.texcoord) >= vertices.texcoords.size())
            return std::nullopt;
        const auto& set = vertices.texcoords[static_cast<std::size_t>(use.texcoord)];
        const Texture& texture = picture_.textures[static_cast<std::size_t>(use.image)];
        const glm::vec3& origin = picture_.camera.position;
        const auto coordinate = [&](const glm::vec2& barycentrics) {
            return use.transform * glm::vec3(interpolated(set, t, barycentrics), 1);
        };
        const glm::vec2 size(texture.levels[0].width, texture.levels[0].height);
        const glm::vec2 at = coordinate(uv);
        const glm::vec2 dx =
            (coordinate(plane_barycentrics(corners, origin, direction(x + 1, y))) - at) * size;
        const glm::vec2 dy =
            (coordinate(plane_barycentrics(corners, origin, direction(x, y + 1))) - at) * size;
        const float lod = 0.5f * std::log2(std::max(glm::dot(dx, dx), glm::dot(dy, dy)));
        return sample(texture, use, at, std::isfinite(lod) ? lod : 0.0f);
    }

    const Picture& picture_;
    const RayScene& rays_;
    CameraFrame frame_;
    int width_, height_;
};

} // namespace

Image render_rays(const Picture& picture, const RayScene& ray_scene, int threads) {
    return RayRenderer(picture, ray_scene).render(threads);
}

} // namespace prt

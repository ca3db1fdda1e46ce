// Converts between pixels and directions.

#include "core/screen.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace viewer {

glm::vec3 direction_through(const Screen& screen, const glm::vec2& pixel) {
    const glm::ivec2 size(screen.size);
    return glm::vec3(
        glm::normalize(prt::view_direction(prt::camera_frame(screen.camera), size.x, size.y,
                                           static_cast<double>(pixel.x), static_cast<double>(pixel.y))));
}

std::optional<glm::vec2> pixel_of(const Screen& screen, const glm::vec3& point) {
    const prt::CameraFrame frame = prt::camera_frame(screen.camera);
    const glm::dvec3 v(point - screen.camera.position);
    const double depth = glm::dot(v, frame.forward);
    if (depth <= 0)
        return std::nullopt;
    const double aspect = static_cast<double>(screen.size.x / screen.size.y),
                 scale = 1 / (depth * frame.half_height);
    const glm::dvec2 at(glm::dot(v, frame.right) * scale / aspect, -glm::dot(v, frame.up) * scale);
    return glm::vec2((at + 1.0) * 0.5 * glm::dvec2(screen.size));
}

glm::vec3 direction_on_sphere(const Screen& screen, const glm::vec2& pixel, const glm::vec3& center,
                              float radius, bool far_side) {
    const glm::vec3 d = direction_through(screen, pixel), to_center = center - screen.camera.position;
    const float along = glm::dot(to_center, d);
    const glm::vec3 nearest = d * along - to_center; // vector from the center to the nearest point of the ray
    const float inside = radius * radius - glm::dot(nearest, nearest);
    if (inside <= 0)
        return glm::normalize(nearest);
    const bool from_within = glm::dot(to_center, to_center) < radius * radius;
    return glm::normalize(nearest + d * (far_side || from_within ? std::sqrt(inside) : -std::sqrt(inside)));
}

} // namespace viewer

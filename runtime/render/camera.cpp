// Cameras: automatic placement, view directions and projection.
#include "prt/render/camera.h"

#include "prt/core/error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prt {

namespace {

/// Calls `visit` with every corner of every triangle.
template <class Visit>
void for_each_corner(const Scene& scene, Visit&& visit) {
    for (const Primitive& primitive : scene.primitives)
        for (const glm::uvec3& t : primitive.triangles)
            for (int corner = 0; corner < 3; ++corner)
                visit(scene.vertex_arrays[primitive.vertices].positions[t[corner]]);
}

} // namespace

Camera automatic_camera(const Scene& scene, float aspect, float vertical_field_of_view) {
    Camera camera;
    camera.vertical_field_of_view = vertical_field_of_view;
    const Bounds box = bounds(scene);
    camera.target = box.low + 0.5f * (box.high - box.low);
    const glm::vec3 from = glm::normalize(glm::vec3(0.45f, 0.35f, 1.0f));
    const glm::vec3 right = glm::normalize(glm::cross(camera.up, from)), up = glm::cross(from, right);
    const float tangent = std::tan(0.5f * camera.vertical_field_of_view);
    for (int round = 0; round < 4;
         ++round) { // moving the target changes the distance, which changes the best target
        // The distance at which every triangle is inside the view, with a margin.
        float distance = 0;
        for_each_corner(scene, [&](const glm::vec3& p) {
            const glm::vec3 v = p - camera.target;
            distance = std::max(distance, glm::dot(v, from) +
                                              std::max(std::abs(glm::dot(v, up)) / tangent,
                                                       std::abs(glm::dot(v, right)) / (tangent * aspect)));
        });
        distance = distance > 0 ? 1.08f * distance : 1; // otherwise all vertices are at one point
        camera.position = camera.target + from * distance;
        if (round == 3)
            break;
        glm::vec2 low(std::numeric_limits<float>::infinity()), high = -low;
        for_each_corner(scene, [&](const glm::vec3& p) {
            const glm::vec3 v = p - camera.position;
            const glm::vec2 seen = glm::vec2(glm::dot(v, right), glm::dot(v, up)) / -glm::dot(v, from);
            low = glm::min(low, seen);
            high = glm::max(high, seen);
        });
        camera.target += 0.5f * distance * (right * (low.x + high.x) + up * (low.y + high.y));
    }
    return camera;
}

CameraFrame camera_frame(const Camera& camera) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(camera.position[axis]) <= kFarthestCamera &&
              std::abs(camera.target[axis]) <= kFarthestCamera))
            throw Error(
                "the position or the target of the camera is not finite or more than 1e18 m from the origin");
    const glm::dvec3 view(camera.target - camera.position);
    const glm::dvec3 side = glm::cross(view, glm::dvec3(camera.up));
    if (!(glm::length(side) > 0))
        throw Error(
            "the camera must not look straight up or down, and its target must differ from its position");
    CameraFrame frame;
    frame.forward = glm::normalize(view);
    frame.right = glm::normalize(side);
    frame.up = glm::cross(frame.right, frame.forward);
    frame.half_height = std::tan(0.5 * static_cast<double>(camera.vertical_field_of_view));
    return frame;
}

glm::dvec3 view_direction(const CameraFrame& frame, int width, int height, double x, double y) {
    const double aspect = static_cast<double>(width) / height;
    return frame.forward + frame.right * (frame.half_height * aspect * (2 * x / width - 1)) +
           frame.up * (frame.half_height * (1 - 2 * y / height));
}

glm::mat4 view_projection(const Camera& camera, const Bounds& box, float aspect) {
    const CameraFrame frame = camera_frame(camera);
    const glm::dvec3 position(camera.position);
    double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 v(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                           corner & 4 ? box.high.z : box.low.z);
        const double depth = glm::dot(v - position, frame.forward);
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
    if (!(farthest > 0)) // everything is behind the camera
        farthest = 1;
    const double near_plane = std::max(nearest * 0.99, farthest * 1e-4);
    const glm::dmat4 projection =
        glm::perspective(static_cast<double>(camera.vertical_field_of_view), static_cast<double>(aspect),
                         near_plane, std::max(farthest * 1.01, near_plane * 1.01));
    return glm::mat4(projection * glm::lookAt(position, position + frame.forward, glm::dvec3(camera.up)));
}

} // namespace prt

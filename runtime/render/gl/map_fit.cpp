// Fits boxes along the light direction to slices of the view (M. Wimmer, D. Scherzer, W. Purgathofer, "Light
// Space Perspective Shadow Maps", 2004, section 4, for the enclosed bodies; F. Zhang et al., "Parallel-split
// Shadow Maps", 2006, for the slices).

#include "runtime/render/gl/map_fit.h"

#include "runtime/core/support/tangent_frame.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace prt {
namespace {

/// Half space of a convex body: dot(normal, x) <= offset.
struct HalfSpace {
    glm::dvec3 normal;
    double offset;
};

/// Returns the corners of the intersection of all half spaces: intersections of three planes inside all
/// others.
std::vector<glm::dvec3> corners_of(const std::vector<HalfSpace>& body, double tolerance) {
    std::vector<glm::dvec3> corners;
    for (std::size_t i = 0; i < body.size(); ++i)
        for (std::size_t j = i + 1; j < body.size(); ++j)
            for (std::size_t k = j + 1; k < body.size(); ++k) {
                const glm::dmat3 normals(body[i].normal, body[j].normal, body[k].normal);
                if (std::abs(glm::determinant(normals)) < 1e-9) // two of them are parallel
                    continue;
                const glm::dvec3 corner = glm::inverse(glm::transpose(normals)) *
                                          glm::dvec3(body[i].offset, body[j].offset, body[k].offset);
                if (std::all_of(body.begin(), body.end(), [&](const HalfSpace& h) {
                        return glm::dot(h.normal, corner) <= h.offset + tolerance;
                    }))
                    corners.push_back(corner);
            }
    return corners;
}

std::vector<glm::dvec3> box_corners(const SeenScene& seen) {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(glm::dvec3(i & 1 ? seen.box.high.x : seen.box.low.x,
                                     i & 2 ? seen.box.high.y : seen.box.low.y,
                                     i & 4 ? seen.box.high.z : seen.box.low.z) -
                          glm::dvec3(seen.camera.position));
    return corners;
}

/// Returns the intersection of the box and the view frustum, relative to the eye, with a margin of half a
/// pixel around the picture.
std::vector<HalfSpace> seen_body(const SeenScene& seen, const CameraFrame& frame) {
    std::vector<HalfSpace> body;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 normal(0);
        normal[axis] = 1;
        const auto eye = static_cast<double>(seen.camera.position[axis]);
        body.push_back({normal, static_cast<double>(seen.box.high[axis]) - eye});
        body.push_back({-normal, eye - static_cast<double>(seen.box.low[axis])});
    }
    const double up = frame.half_height * (seen.height + 1) / seen.height,
                 right = frame.half_height * (seen.width + 1) / seen.height;
    for (const double side : {-1.0, 1.0}) {
        body.push_back({glm::normalize(side * frame.up - up * frame.forward), 0});
        body.push_back({glm::normalize(side * frame.right - right * frame.forward), 0});
    }
    return body;
}

/// Minimum and maximum of `points` along an axis.
struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -low;

    Range(const std::vector<glm::dvec3>& points, const glm::dvec3& axis) {
        for (const glm::dvec3& p : points) {
            low = std::min(low, glm::dot(p, axis));
            high = std::max(high, glm::dot(p, axis));
        }
    }
    double length() const { return high - low; }
};

/// Axes of a map: across, up, and along the light.
struct MapAxes {
    glm::dvec3 across, up, along;
};

/// Returns the axes for which the bounding rectangle of the slice is smallest, among rotations about the
/// light direction.
MapAxes axes_of(const Sun& sun, const Slice& slice) {
    constexpr int kRotations = 24;
    const glm::dvec3 along = -glm::normalize(glm::dvec3(sun.towards));
    const TangentFrame frame = tangent_frame(sun.towards);
    const glm::dvec3 first = glm::normalize(glm::cross(glm::dvec3(frame.bitangent), along)),
                     second = glm::cross(along, first);
    MapAxes best{};
    double least = std::numeric_limits<double>::infinity();
    for (int rotation = 0; rotation < kRotations; ++rotation) {
        const double angle = 0.5 * std::numbers::pi * rotation / kRotations;
        const MapAxes axes{std::cos(angle) * first + std::sin(angle) * second,
                           std::cos(angle) * second - std::sin(angle) * first, along};
        const double area =
            Range(slice.corners, axes.across).length() + Range(slice.corners, axes.up).length();
        if (area < least) {
            least = area;
            best = axes;
        }
    }
    return best;
}

/// Bounds of a map. Zero lengths are replaced by a small fraction of the scene size.
struct MapBox {
    MapAxes axes;
    Range across, up, along;

    MapBox(const Sun& sun, const Slice& slice, const SeenScene& seen)
        : axes(axes_of(sun, slice)), across(slice.corners, axes.across), up(slice.corners, axes.up),
          along(slice.corners, axes.along) {
        const std::vector<glm::dvec3> scene = box_corners(seen);
        along.low = Range(scene, axes.along).low; // includes all casters towards the light
        const double least = 1e-5 * glm::length(glm::dvec3(seen.box.high) - glm::dvec3(seen.box.low)) +
                             std::numeric_limits<float>::min();
        const double spread = tangent_of(sun) * along.length();
        widen(across, spread, Range(scene, axes.across), least);
        widen(up, spread, Range(scene, axes.up), least);
        along.low -= least;
        along.high += least;
    }

private:
    /// Widens the range by the reach of the sun's disc to the side, limited to the scene.
    static void widen(Range& range, double spread, const Range& scene, double least) {
        range.low = std::max(range.low - spread, scene.low) - least;
        range.high = std::min(range.high + spread, scene.high) + least;
    }
};

} // namespace

double tangent_of(const Sun& sun) {
    return std::tan(std::min(sun.half_angle, 1.2));
}

std::vector<Slice> slices_of(const SeenScene& seen) {
    const CameraFrame frame = camera_frame(seen.camera);
    const std::vector<HalfSpace> body = seen_body(seen, frame);
    const Range depths(box_corners(seen), frame.forward);
    const double far = depths.high, tolerance = 1e-9 * std::max(std::abs(far), std::abs(depths.low));
    std::vector<Slice> slices;
    double to = far;
    while (to > 0 && to > depths.low && slices.size() < PRT_MAX_SLICES) {
        const bool last = slices.size() + 1 == PRT_MAX_SLICES;
        Slice slice{last ? 0.0 : 0.25 * to, to, {}};
        slice.from = std::max(slice.from, depths.low > 0 ? depths.low : 0.0);
        std::vector<HalfSpace> piece = body;
        piece.push_back({frame.forward, slice.to});
        piece.push_back({-frame.forward, -slice.from});
        slice.corners = corners_of(piece, tolerance);
        to = slice.from;
        slices.push_back(std::move(slice));
    }
    std::reverse(slices.begin(), slices.end());
    return slices;
}

double texels_wanted(const Sun& sun, const Slice& slice, const SeenScene& seen) {
    constexpr double kPerPixel = 2;
    const MapBox box(sun, slice, seen);
    const double nearest = std::max(slice.from, 0.25 * slice.to);
    const double pixel = 2 * camera_frame(seen.camera).half_height * nearest / seen.height;
    return kPerPixel * std::max(box.across.length(), box.up.length()) / pixel;
}

suns::SunMap fitted_map(const Sun& sun, const Slice& slice, const SeenScene& seen, int size) {
    const MapBox box(sun, slice, seen);
    const double texels = size - 2 * PRT_MAP_BORDER;
    const double x = texels / box.across.length(), y = texels / box.up.length();
    const auto row = [](const glm::dvec3& axis, double scale, double first) {
        return glm::vec4(glm::dvec4(axis * scale, first));
    };
    return {row(box.axes.across, x, PRT_MAP_BORDER - box.across.low * x),
            row(box.axes.up, y, PRT_MAP_BORDER - box.up.low * y),
            row(box.axes.along, 1, -box.along.low),
            glm::vec2(glm::dvec2(x, y)),
            static_cast<float>(box.along.length()),
            static_cast<float>(1 / std::min(x, y))};
}

} // namespace prt

// Environment maps: checks, repair of pixels, and view directions of pixels.
#include "prt/core/environment.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace prt {

using std::numbers::pi;

namespace {

bool is_bad(const glm::vec3& pixel) {
    for (int c = 0; c < 3; ++c)
        if (!std::isfinite(pixel[c]) || pixel[c] < 0)
            return true;
    return false;
}

struct CubeFace {
    glm::dvec3 outward, right, down;
};

constexpr std::array<CubeFace, 6> kExrFaces = {{
    {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
    {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}},
}};

constexpr std::array<CubeFace, 6> kApiFaces = {{
    {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
    {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
    {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
}};

/// Interpolates four texels bilinearly.
glm::vec3 bilinear(const Image& image, int x0, int x1, int y0, int y1, float u, float v) {
    return (image.at(x0, y0) * (1 - u) + image.at(x1, y0) * u) * (1 - v) +
           (image.at(x0, y1) * (1 - u) + image.at(x1, y1) * u) * v;
}

/// Samples bilinearly within the square of `size` texels whose first row is `top`, at the position (x, y) in
/// texels with centers at integers; clamps at the border.
glm::vec3 sample_square(const Image& image, int top, int size, double x, double y) {
    const int last = size - 1;
    x = x > 0 ? std::min(x, double(last)) : 0; // also for NaN
    y = y > 0 ? std::min(y, double(last)) : 0;
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    return bilinear(image, x0, std::min(x0 + 1, last), top + y0, top + std::min(y0 + 1, last),
                    static_cast<float>(x - x0), static_cast<float>(y - y0));
}

glm::vec3 sample_cube(const Image& image, EnvironmentLayout layout, const glm::vec3& direction) {
    const auto& faces = layout == EnvironmentLayout::cube ? kExrFaces : kApiFaces;
    const glm::dvec3 d(direction);
    std::size_t face = 0;
    for (std::size_t f = 1; f < 6; ++f)
        if (glm::dot(d, faces[f].outward) > glm::dot(d, faces[face].outward))
            face = f;
    const CubeFace& f = faces[face];
    const double depth = glm::dot(d, f.outward);
    const auto position = [&](const glm::dvec3& axis) {
        const double share = (glm::dot(d, axis) / depth + 1) * 0.5;
        return layout == EnvironmentLayout::cube ? share * (image.width - 1) : share * image.width - 0.5;
    };
    return sample_square(image, static_cast<int>(face) * image.width, image.width, position(f.right),
                         position(f.down));
}

glm::vec3 sample_angular(const Image& image, const glm::vec3& direction) {
    const double angle = std::acos(std::clamp(-static_cast<double>(direction.z), -1.0, 1.0));
    const double off_axis = std::hypot(direction.x, direction.y);
    const double factor = off_axis > 0 ? angle / pi / off_axis : 0;
    const double u = factor * static_cast<double>(direction.x),
                 v = -factor * static_cast<double>(direction.y);
    return sample_square(image, 0, image.width, (u + 1) * 0.5 * image.width - 0.5,
                         (v + 1) * 0.5 * image.height - 0.5);
}

glm::dvec3 direction_on(const CubeFace& f, double u, double v) {
    return glm::normalize(f.outward + u * f.right + v * f.down);
}

} // namespace

std::size_t repair_pixels(Image& image, BadPixels policy) {
    float largest = 0;
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (is_bad(image.pixels[i]) && count++ == 0)
            first = i;
        for (int c = 0; c < 3; ++c)
            if (std::isfinite(image.pixels[i][c]))
                largest = std::max(largest, image.pixels[i][c]);
    }
    if (count == 0)
        return 0;
    if (policy == BadPixels::error) {
        const auto width = static_cast<std::size_t>(image.width);
        throw Error(counted(count, "pixel is", "pixels are") +
                    " negative, infinite or not a number; the first is at x " +
                    std::to_string(first % width) + ", y " + std::to_string(first / width) +
                    " (they can be read as black or clamped)");
    }
    for (glm::vec3& pixel : image.pixels) {
        if (!is_bad(pixel))
            continue;
        if (policy == BadPixels::zero) {
            pixel = glm::vec3(0);
            continue;
        }
        for (int c = 0; c < 3; ++c)
            pixel[c] = std::isnan(pixel[c]) ? 0.0f : std::clamp(pixel[c], 0.0f, largest);
    }
    return count;
}

glm::dvec3 lat_long_direction(int width, int height, double x, double y) {
    const double longitude = 2 * pi * (0.5 - x / width);
    const double theta = pi * y / height;
    return {std::sin(theta) * std::sin(longitude), std::cos(theta), std::sin(theta) * std::cos(longitude)};
}

glm::dvec2 lat_long_position(int width, int height, const glm::dvec3& direction) {
    const double longitude = std::atan2(direction.x, direction.z);
    const double theta = std::acos(std::clamp(direction.y, -1.0, 1.0));
    return {(0.5 - longitude / (2 * pi)) * width, theta / pi * height};
}

glm::dvec3 cube_direction(int face, double u, double v) {
    return direction_on(kExrFaces[static_cast<std::size_t>(face)], u, v);
}

glm::dvec3 cube_face_direction(int face, double u, double v) {
    return direction_on(kApiFaces[static_cast<std::size_t>(face)], u, v);
}

glm::dvec3 angular_direction(double u, double v) {
    const double distance = std::hypot(u, v), angle = pi * distance;
    const double factor = distance > 0 ? std::sin(angle) / distance : pi;
    return {factor * u, -factor * v, -std::cos(angle)};
}

glm::vec3 sample_lat_long(const Image& image, const glm::vec3& direction) {
    glm::dvec2 position = lat_long_position(image.width, image.height, glm::dvec3(direction)) - 0.5;
    for (int axis = 0; axis < 2; ++axis)
        if (!(position[axis] > -1)) // NaN, for an invalid direction
            position[axis] = -1;
    const double x = std::floor(position.x), y = std::floor(position.y);
    const auto wrap = [&](int i) { return (i % image.width + image.width) % image.width; };
    const auto clamp = [&](int i) { return std::clamp(i, 0, image.height - 1); };
    const int xi = static_cast<int>(x), yi = static_cast<int>(y);
    return bilinear(image, wrap(xi), wrap(xi + 1), clamp(yi), clamp(yi + 1),
                    static_cast<float>(position.x - x), static_cast<float>(position.y - y));
}

glm::vec3 sample(const Environment& environment, const glm::vec3& direction) {
    switch (environment.layout) {
    case EnvironmentLayout::cube:
    case EnvironmentLayout::cube_faces:
        return sample_cube(environment.image, environment.layout, direction);
    case EnvironmentLayout::angular:
        return sample_angular(environment.image, direction);
    case EnvironmentLayout::lat_long:
        break;
    }
    if (environment.center == LatLongCenter::x) // rotates +X of the world to +Z
        return sample_lat_long(environment.image, {-direction.z, direction.y, direction.x});
    return sample_lat_long(environment.image, direction);
}

void check_environment(const Environment& environment) {
    const Image& image = environment.image;
    if (image.width < 1 || image.height < 1)
        throw Error("the environment has no pixels");
    const std::string size = std::to_string(image.width) + " x " + std::to_string(image.height);
    if (image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
        throw Error("the environment is " + size + " pixels, but has data for " +
                    std::to_string(image.pixels.size()));
    switch (environment.layout) {
    case EnvironmentLayout::cube:
    case EnvironmentLayout::cube_faces:
        if (image.height % 6 != 0 || image.height / 6 != image.width)
            throw Error("is " + size + " pixels, but a cube map must have six square faces in a column");
        break;
    case EnvironmentLayout::angular:
        if (image.width != image.height)
            throw Error("is " + size + " pixels, but an angular map must be square");
        break;
    case EnvironmentLayout::lat_long:
        break;
    }
}

Image resampled_lat_long(const Environment& environment) {
    check_environment(environment);
    const Image& image = environment.image;
    const bool lat_long = environment.layout == EnvironmentLayout::lat_long;
    if (lat_long && environment.center == LatLongCenter::z)
        return image;
    // A face of a cube spans 90 degrees, an angular map 360 degrees, the height of the result 180 degrees. If
    // the width of a lat-long image is a multiple of four, the rotation by 90 degrees is exact in pixels.
    const int height = lat_long                                           ? image.height
                       : environment.layout == EnvironmentLayout::angular ? std::max(1, image.width / 2)
                                                                          : 2 * image.width;
    const int width = lat_long ? image.width : 2 * height;
    Image result{width, height, {}};
    result.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            result.at(x, y) =
                lat_long && width % 4 == 0
                    ? image.at((x + width / 4) % width, y)
                    : sample(environment, glm::vec3(lat_long_direction(width, height, x + 0.5, y + 0.5)));
    return result;
}

} // namespace prt

#pragma once

// Environment maps (images of distant radiance) in memory, and their projection into SH. docs/conventions.md,
// "Environment maps", defines the layouts. Stable.

#include "prt/core/glm_layout.h"
#include "prt/core/light.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// Image of RGB pixels in linear Rec. 709.
struct Image {
    int width = 0, height = 0;     ///< in pixels
    std::vector<glm::vec3> pixels; ///< [height][width], row by row; row 0 is the top, column 0 the left

    /// Returns the pixel in column `x`, 0..width - 1, of row `y`, 0..height - 1. Does not check the range.
    const glm::vec3& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    /// Returns the pixel in column `x` of row `y` for writing, under the conditions of the const overload.
    glm::vec3& at(int x, int y) { return const_cast<glm::vec3&>(static_cast<const Image&>(*this).at(x, y)); }
};

/// Mapping from the pixels of an environment map to directions.
enum class EnvironmentLayout {
    /// Latitude and longitude, any image size: the top edge is +Y, the bottom edge -Y, and the width is a
    /// full circle. `Environment::center` is the direction of the center column.
    lat_long,
    /// OpenEXR cube: six square faces +X -X +Y -Y +Z -Z, one below the other. The centers of border texels
    /// are on the edges of the cube. `cube_direction` defines the orientation of the faces.
    cube,
    /// Cube of OpenGL, Vulkan and Direct3D: six square faces +X -X +Y -Y +Z -Z, one below the other, in the
    /// orientation of these interfaces (`cube_face_direction`). The edges of border texels are on the edges
    /// of the cube.
    cube_faces,
    /// Angular map (Debevec's light probes): a square image with all directions inside its inscribed circle.
    /// The center is -Z, +X is to the right, +Y up. The angle to -Z grows linearly with the distance from the
    /// center, up to pi at the circle. Pixels outside the circle have no direction.
    angular,
};

/// Horizontal direction that the center column of a lat-long image shows.
enum class LatLongCenter {
    z, ///< +Z; +X is a quarter of the width left of the center. Convention of OpenEXR
    x, ///< +X; -Z is a quarter of the width left of the center. Convention of three.js, glTF viewers, Blender
};

/// An environment map: distant radiance from every direction.
struct Environment {
    Image image;                                            ///< radiance
    EnvironmentLayout layout = EnvironmentLayout::lat_long; ///< directions of the pixels of `image`
    LatLongCenter center = LatLongCenter::z;                ///< ignored by all layouts except `lat_long`
};

/// Throws `Error` unless width and height are at least 1, the number of pixels is width x height, and the
/// size fits the layout: height 6 x width for both cube layouts, height equal to width for `angular`. Does
/// not check the values of pixels.
void check_environment(const Environment& environment);

/// Treatment of bad pixels: pixels with a component that is NaN, infinite or negative.
enum class BadPixels {
    error, ///< throw `Error` with the number of bad pixels and the position of the first
    zero,  ///< set all three components of each bad pixel to 0
    /// In bad pixels, set NaN and negative components to 0, and components of +infinity to the largest finite
    /// component of the image in any channel. Keep all other components.
    clamp,
};

/// Changes bad pixels of `image` as `policy` specifies. Returns the number of bad pixels. Under
/// `BadPixels::error` it changes nothing, and throws `Error` if there are bad pixels.
std::size_t repair_pixels(Image& image, BadPixels policy);

/// Returns the unit direction at the position (x, y) of a lat-long image with the center +Z
/// (`LatLongCenter::z`). Positions are in pixels from the left and top edges: pixel i covers [i, i + 1] and
/// has its center at i + 0.5.
glm::dvec3 lat_long_direction(int width, int height, double x, double y);

/// Returns the position (x, y) of unit direction `direction` in a lat-long image with the center +Z: the
/// inverse of `lat_long_direction`. x is in [0, width] from the left edge, y in [0, height] from the top
/// edge.
glm::dvec2 lat_long_position(int width, int height, const glm::dvec3& direction);

/// Returns the unit direction at the position (u, v) of face 0..5 (+X -X +Y -Y +Z -Z) in the layout
/// `EnvironmentLayout::cube`. u grows to the right and v downwards in the image; the face is [-1, 1]². Texel
/// i of n > 1 along an axis is centered at 2 i / (n - 1) - 1; a single texel covers the face.
glm::dvec3 cube_direction(int face, double u, double v);

/// Returns the unit direction at the position (u, v) of face 0..5 (+X -X +Y -Y +Z -Z) in the layout
/// `EnvironmentLayout::cube_faces`. u grows to the right and v downwards in the image; the face is [-1, 1]².
/// Texel i of n along an axis is centered at (2 i + 1) / n - 1.
glm::dvec3 cube_face_direction(int face, double u, double v);

/// Returns the unit direction at the position (u, v) of an image in the layout `EnvironmentLayout::angular`.
/// u grows to the right and v downwards; the image is [-1, 1]², and u² + v² must be at most 1.
glm::dvec3 angular_direction(double u, double v);

/// Returns the radiance from unit direction `direction`, by bilinear filtering. Filters of cube maps do not
/// cross the edges of faces. Filters of angular maps also read pixels outside the circle for directions close
/// to +Z. The environment must pass `check_environment`. For a direction that is not finite the result is the
/// radiance at an arbitrary position.
glm::vec3 sample(const Environment& environment, const glm::vec3& direction);
/// Returns the radiance from unit direction `direction`, by bilinear filtering, in a lat-long image with the
/// center +Z (`LatLongCenter::z`). The image must have pixels. For a direction that is not finite the result
/// is the radiance at an arbitrary position.
glm::vec3 sample_lat_long(const Image& image, const glm::vec3& direction);

/// Returns the environment as a lat-long image with the center +Z (`LatLongCenter::z`). A lat-long image
/// keeps its size: with the center +Z it is copied; with the center +X and a width divisible by four its
/// columns are shifted without loss. All other environments are resampled by `sample`. The result of a cube
/// map is twice as high as a face is wide, that of an angular map half as high as the map (rounded down, at
/// least 1); both are twice as wide as high. Throws the errors of `check_environment`.
Image resampled_lat_long(const Environment& environment);

/// Returns the SH coefficients of the environment in `order` bands, 1..kMaxOrder. Radiance is constant over
/// each texel, and the basis is integrated over the texel: a lat-long image of one pixel is exactly a
/// constant light. Uses `threads` threads (0: all hardware threads); the result does not depend on their
/// number. Throws `Error` for an invalid order, and the errors of `check_environment`, and `Error` for an
/// invalid order or if a coefficient is NaN or exceeds 1e18 in magnitude (a coefficient is NaN or exceeds
/// 1e18 in magnitude).
Light project(const Environment& environment, int order, int threads = 0);

} // namespace prt

#pragma once

// Environment maps in memory and their projection into SH. Layouts: docs/math.md, section 3. Stable.

#include "prt/light.h"
#include "prt/support/glm_layout.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// RGB pixels, row by row from the top, linear Rec. 709.
struct Image {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels; ///< [height][width]

    /// Returns the pixel in column `x` of row `y`.
    const glm::vec3& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    glm::vec3& at(int x, int y) { return const_cast<glm::vec3&>(static_cast<const Image&>(*this).at(x, y)); }
};

/// Mapping from the pixels of an environment map to directions.
enum class EnvironmentLayout {
    lat_long, ///< any size; top row +Y; `LatLongCenter` defines the center column
    cube,     ///< OpenEXR: faces +X -X +Y -Y +Z -Z in a column, border texels centered on the cube's edges
    /// OpenGL, Vulkan and Direct3D: the same face order in a column, each face rotated and mirrored as these
    /// APIs do; texels are cells of equal size.
    cube_faces,
    /// Square image with all directions in a circle: the center looks at -Z, +X is right, +Y up. The angle to
    /// -Z grows linearly with the distance from the center up to pi on the rim (Debevec's light probes). The
    /// corners are ignored.
    angular,
};

/// Direction of the center column of a lat-long image.
enum class LatLongCenter {
    z, ///< +Z, and +X is a quarter of the width to the left: OpenEXR
    x, ///< +X, and -Z is a quarter of the width to the left: three.js, glTF viewers, Blender
};

/// An environment map: radiance from every direction.
struct Environment {
    Image image;
    EnvironmentLayout layout = EnvironmentLayout::lat_long;
    LatLongCenter center = LatLongCenter::z; ///< ignored by other layouts
};

/// Throws `Error` unless the image has pixels, their number equals width x height, and the size fits its
/// layout.
void check_environment(const Environment& environment);

/// Treatment of pixels that cannot be radiance.
enum class BadPixels {
    error, ///< throw `Error` with their number and the position of the first
    zero,  ///< make them black
    clamp, ///< NaN and negative become 0, +infinity the largest finite value of the image
};

/// Repairs pixels that have a NaN, infinite or negative component, as `policy` specifies. Returns the number
/// of these pixels. Throws `Error` under `BadPixels::error` if there are any.
std::size_t repair_pixels(Image& image, BadPixels policy);

/// Returns the unit direction at pixel position (x, y), where pixel i covers [i, i + 1]; the center looks at
/// +Z.
glm::dvec3 lat_long_direction(int width, int height, double x, double y);

/// Returns the pixel position of a unit direction, as in `lat_long_direction`; x in [0, width], y in [0,
/// height].
glm::dvec2 lat_long_position(int width, int height, const glm::dvec3& direction);

/// Returns the unit direction at (u, v) in [-1, 1]² of face 0..5 of a cube map, u to the right and v down in
/// the image. Texel i of n along an axis is centered at 2 i / (n - 1) - 1.
glm::dvec3 cube_direction(int face, double u, double v);

/// Returns the unit direction at (u, v) of face 0..5 for the layout `cube_faces`. Texel i of n along an axis
/// is centered at (2 i + 1) / n - 1.
glm::dvec3 cube_face_direction(int face, double u, double v);

/// Returns the unit direction at (u, v) of an angular map, u right and v down in [-1, 1], u² + v² <= 1.
glm::dvec3 angular_direction(double u, double v);

/// Returns bilinearly filtered radiance in unit direction `direction`. The environment must pass
/// `check_environment`. A direction that is not finite yields the radiance of an arbitrary pixel.
glm::vec3 sample(const Environment& environment, const glm::vec3& direction);
/// Returns bilinearly filtered radiance of a lat-long image whose center looks at +Z, in unit direction
/// `direction`.
glm::vec3 sample_lat_long(const Image& image, const glm::vec3& direction);

/// Returns the environment as a lat-long image whose center looks at +Z. An environment in that layout is
/// copied or shifted; others are resampled by `sample` at about their resolution. Throws the errors of
/// `check_environment`.
Image resampled_lat_long(const Environment& environment);

/// Projects the environment, piecewise constant over its texels, into SH. The basis is integrated over each
/// texel instead of evaluated at its center, so that an image of one pixel is exactly a constant light. Sums
/// are in double, row by row in a fixed order: the result does not depend on `threads` (0: all). Throws the
/// errors of `check_environment` and `check_light`.
Light project(const Environment& environment, int order, int threads = 0);

} // namespace prt

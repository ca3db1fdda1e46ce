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

    const glm::vec3& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    glm::vec3& at(int x, int y) { return const_cast<glm::vec3&>(static_cast<const Image&>(*this).at(x, y)); }
};

enum class EnvironmentLayout {
    lat_long, ///< any size; top row +Y; center column and what is left of it: `LatLongCenter`
    cube,     ///< OpenEXR's: faces +X -X +Y -Y +Z -Z in a column, border texels centerd on the cube's edges
    /// OpenGL's, Vulkan's and Direct3D's: the same order in a column, each face turned and mirrored as they
    /// do, texels cells of equal size.
    cube_faces,
    /// Square, all directions in a circle: the center looks at -Z, +X is right, +Y up, the angle to -Z grows
    /// with the distance from the center up to pi on the rim (Debevec's light probes). Corners count for
    /// nothing.
    angular,
};

/// What the center column of a lat-long image looks at.
enum class LatLongCenter {
    z, ///< +Z, and +X is a quarter of the width left of it: OpenEXR
    x, ///< +X, and -Z is a quarter of the width left of it: three.js, glTF viewers and Blender show them so
};

struct Environment {
    Image image;
    EnvironmentLayout layout = EnvironmentLayout::lat_long;
    LatLongCenter center = LatLongCenter::z; ///< other layouts do not care
};

/// Throws `Error` unless the image has pixels, as many as its size says, and the shape of its layout.
void check_environment(const Environment& environment);

/// What to do with pixels that cannot be radiance.
enum class BadPixels {
    error, ///< throw `Error` that counts them and names the first
    zero,  ///< make them black
    clamp, ///< NaN and negative become 0, +infinity the largest finite value of the image
};

/// Number of pixels with a NaN, infinite or negative component; they are treated as `policy` says.
/// Throws `Error` under `BadPixels::error` when there are any.
std::size_t repair_pixels(Image& image, BadPixels policy);

/// Unit direction at the pixel position (x, y), where pixel i covers [i, i + 1]; the center looks at +Z.
glm::dvec3 lat_long_direction(int width, int height, double x, double y);

/// Pixel position, as in `lat_long_direction`, of a unit direction; x in [0, width], y in [0, height].
glm::dvec2 lat_long_position(int width, int height, const glm::dvec3& direction);

/// Unit direction at (u, v) in [-1, 1]² of face 0..5 of a cube map, u to the right and v down in the image.
/// Texel i of n along an axis is centerd at 2 i / (n - 1) - 1.
glm::dvec3 cube_direction(int face, double u, double v);

/// The same for the layout `cube_faces`, where texel i of n along an axis is centerd at (2 i + 1) / n - 1.
glm::dvec3 cube_face_direction(int face, double u, double v);

/// Unit direction at (u, v) of an angular map, u right and v down in [-1, 1], u² + v² <= 1.
glm::dvec3 angular_direction(double u, double v);

/// Bilinearly filtered radiance in unit direction `direction`, of an environment that `check_environment`
/// lets pass; some pixels' in a direction that is not finite.
glm::vec3 sample(const Environment& environment, const glm::vec3& direction);
glm::vec3 sample_lat_long(const Image& image, const glm::vec3& direction);

/// The environment as a lat-long image whose center looks at +Z: such a one as it is, others by `sample` at
/// about their resolution. Throws as `check_environment`.
Image resampled_lat_long(const Environment& environment);

/// Projects the environment, piecewise constant over its texels, into SH: the basis is integrated over each
/// texel, not only taken at its center, so that an image of one pixel is exactly a constant light. Sums are
/// in double, row by row in a fixed order: the result does not depend on `threads` (0: all). Throws as
/// `check_environment` and `check_light`.
Light project(const Environment& environment, int order, int threads = 0);

} // namespace prt

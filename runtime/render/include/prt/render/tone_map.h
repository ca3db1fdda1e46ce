#pragma once

// Converts linear radiance to 8-bit pixels for display. Experimental.

#include "prt/core/environment.h"
#include "prt/core/glm_layout.h"
#include "prt/core/light.h"
#include "prt/core/sh_basis.h"
#include "prt/image/image_file.h"

#include <glm/gtc/type_precision.hpp>

#include <vector>

namespace prt {

/// Curve from radiance times exposure to displayable values.
enum class ToneMap {
    filmic, ///< rational fit of Narkowicz (2016) to the ACES curve, which compresses highlights; then the
            ///< sRGB curve
    srgb,   ///< values are clipped at 1; then the sRGB curve
};

/// Returns the exposure for `tone_mapped`: the factor that scales the mean luminance of `light` over all
/// directions to 0.25. Returns 1 if this mean is not positive. `light` must have at least one band.
float automatic_exposure(const Light& light);

/// Returns the means over blocks of `samples` x `samples` pixels of `image`: [height / samples]
/// [width / samples], rounded down. Incomplete blocks at the right and the bottom are dropped. `samples`: 1
/// or more.
Image downsampled(const Image& image, int samples);

/// Returns 8-bit sRGB pixels, [height / samples][width / samples], rounded down. `image`: linear Rec. 709
/// radiance with `samples` x `samples` samples per pixel. `exposure`: factor on radiance, for example from
/// `automatic_exposure`. Applies exposure and tone curve to each sample, then averages the samples of a
/// pixel, and applies the sRGB curve last. Therefore edges against bright backgrounds stay smooth.
std::vector<glm::u8vec3> tone_mapped(const Image& image, int samples, float exposure, ToneMap tone_map);

} // namespace prt

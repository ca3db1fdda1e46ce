#pragma once

// Conversion of radiance to displayable pixels. Experimental.

#include "prt/environment.h"
#include "prt/light.h"
#include "prt/sh_basis.h"
#include "prt/srgb.h"
#include "prt/support/glm_layout.h"

#include <glm/gtc/type_precision.hpp>

#include <vector>

namespace prt {

/// Curve from radiance to displayable values.
enum class ToneMap {
    filmic, ///< shoulder and toe from the rational fit of Narkowicz (2016) to the ACES curve, then sRGB
    srgb,   ///< clipped at 1, then sRGB
};

/// Returns the factor on radiance that scales the mean radiance of the lighting to 0.25.
float automatic_exposure(const Light& light);

/// Returns the image averaged over blocks of `samples` x `samples` pixels.
Image downsampled(const Image& image, int samples);

/// Returns 8-bit pixels of a linear image with `samples`² samples per pixel, [height / samples][width /
/// samples]. Exposure and tone curve are applied per sample before averaging, so that edges against bright
/// backgrounds stay smooth.
std::vector<glm::u8vec3> tone_mapped(const Image& image, int samples, float exposure, ToneMap tone_map);

} // namespace prt

#pragma once

// The curve of sRGB. Experimental.

namespace prt {

/// The sRGB transfer function (IEC 61966-2-1) and its inverse.
float srgb_encode(float linear);
float srgb_decode(float encoded);

} // namespace prt

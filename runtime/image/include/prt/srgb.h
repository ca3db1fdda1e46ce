#pragma once

// The sRGB curve. Experimental.

namespace prt {

/// Computes the sRGB transfer function (IEC 61966-2-1) and its inverse.
float srgb_encode(float linear);
float srgb_decode(float encoded);

} // namespace prt

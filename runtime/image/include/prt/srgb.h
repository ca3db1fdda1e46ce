#pragma once

// Conversion of one color channel between linear and sRGB values (IEC 61966-2-1). Experimental.

namespace prt {

/// Returns the sRGB value of a linear value. Both are 0..1 (1 is white, not 255); values outside are not
/// clamped.
float srgb_encode(float linear);
/// Returns the linear value of an sRGB value. Both are 0..1 (1 is white, not 255); values outside are not
/// clamped.
float srgb_decode(float encoded);

} // namespace prt

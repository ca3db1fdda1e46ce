#pragma once

// The sRGB curve. Experimental.

namespace prt {

/// Returns the sRGB value of a linear value (IEC 61966-2-1).
float srgb_encode(float linear);
/// Returns the linear value of an sRGB value (IEC 61966-2-1).
float srgb_decode(float encoded);

} // namespace prt

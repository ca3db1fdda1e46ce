#pragma once

#include "picture.h"

namespace examples {

/// "PRT" and a wave below, drawn with tubes of light: white where a tube is, fading into black around it.
/// Twice as wide as high.
SharedPicture neon_sign_picture();

} // namespace examples

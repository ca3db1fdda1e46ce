#pragma once

// Transmission of light by materials. Experimental.

#include "prt/scene.h"

namespace prt {

/// Returns the fraction of light that untextured glass transmits: its factor times the luminance (Rec. 709)
/// of its base color. The color of the light is not changed.
float glass_transmittance(const Material& material);

/// Returns whether the material has a scattering medium below its surface: KHR_materials_volume with a
/// thickness and an attenuation, and KHR_materials_diffuse_transmission, through which light enters. If
/// false, diffuse transmission is that of a thin sheet.
bool has_medium(const Material& material);

} // namespace prt

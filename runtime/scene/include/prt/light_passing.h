#pragma once

// Transmission of light by materials. Experimental.

#include "prt/scene.h"

namespace prt {

/// Returns the fraction of light that untextured glass transmits: its factor, multiplied by the luminance of
/// its base color (Rec. 709), since transmitted light keeps its color.
float glass_transmittance(const Material& material);

/// Returns whether a scattering medium is below the surface: KHR_materials_volume with a thickness and an
/// attenuation, and diffuse light can enter (KHR_materials_diffuse_transmission). Otherwise diffuse
/// transmission is that of a thin sheet.
bool has_medium(const Material& material);

} // namespace prt

#pragma once

// What light does at a material besides being reflected. Experimental.

#include "prt/scene.h"

namespace prt {

/// Share of the light that glass without a texture lets through: its factor, dimmed by its base color as
/// luminance (Rec. 709), since what passes keeps its color.
float glass_transmittance(const Material& material);

/// There is something under the surface that scatters light: KHR_materials_volume with a thickness and an
/// attenuation, where diffuse light is let in (KHR_materials_diffuse_transmission). Without, what lets
/// diffuse light through is a thin sheet.
bool has_medium(const Material& material);

} // namespace prt

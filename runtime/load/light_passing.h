#pragma once

// Transmission of light by materials. Experimental.

#include "prt/core/baked_transfer.h"
#include "prt/load/scene.h"

namespace prt {

/// Returns the fraction of incident light, 0..1, that passes through glass of this material: `glass.factor`
/// times the luminance (linear Rec. 709) of `base_color`. Textures are ignored. The fraction is the same for
/// red, green and blue. 0 if the material is not glass.
float glass_transmittance(const Material& material);

/// Returns whether the material has a scattering medium below its surface. This requires a diffuse
/// transmission factor above 0, through which light enters, a thickness above 0, and a finite attenuation
/// distance above 0. If false, diffuse transmission is that of a thin sheet.
bool has_medium(const Material& material);

/// Returns whether all light passes through a medium below the surface: `has_medium`, or
/// MaterialVolume::baked. Separate suns light such a surface only through transfer.
bool lit_through_medium(const Material& material);

/// Sets MaterialVolume::baked of the materials of `scene` from the record of its transfer.
void mark_media(Scene& scene, const BakeRecord& record);

} // namespace prt

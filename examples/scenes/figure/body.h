#pragma once

#include "figure/soft_limb.h"

namespace examples::anatomy {

/// What the figure wears and is, a mesh for each material.
SoftMesh shirt();
/// Trousers, shoes and hair.
SoftMesh dark_parts();
/// Head, neck and hands.
SoftMesh skin_parts();

} // namespace examples::anatomy

#pragma once

#include "figure/soft_limb.h"

namespace examples::anatomy {

/// Returns the mesh of the shirt. The figure has one mesh per material.
SoftMesh shirt();
/// Returns the mesh of trousers, shoes and hair.
SoftMesh dark_parts();
/// Returns the mesh of head, neck and hands.
SoftMesh skin_parts();

} // namespace examples::anatomy

#pragma once

// Smooth closed surfaces of elliptical sections along an axis, skinned to the joints along it.

#include "mesh.h"
#include "skeleton.h"

#include <span>

namespace examples::anatomy {

/// The axes of a limb: `front` is normal to `axis`, both unit.
struct LimbFrame {
    glm::vec3 origin, axis, front;
};

/// The ellipse at `along` metres of the axis, with half its width (along axis x front) and half its depth
/// (along front), and how far its middle lies from the axis to the front.
struct Section {
    float along, half_width, half_depth, ahead = 0;
};

/// A joint that influences the part after `from` along the axis; between two joints the weights change
/// smoothly within `blend` metres on either side.
struct HeldBy {
    int joint;
    float from = 0, blend = 0;
};

struct LimbShape {
    int segments;                              ///< round the axis
    float spacing = 0.03f;                     ///< distance of the rings along the axis, metres
    float first_cap = 0.01f, last_cap = 0.01f; ///< how far its round ends reach beyond the sections
    float squareness = 2; ///< exponent of the ellipses: 2 for an ellipse, larger for a box-like shape
    float floor = -1;     ///< minimum height: soles are flat
};

/// A mesh with skin weights.
struct SoftMesh {
    Mesh mesh;
    SkinWeights skin;
};

void append(SoftMesh& mesh, const SoftMesh& other);

/// The surface through `sections`, which are in order.
SoftMesh soft_limb(const LimbFrame& frame, std::span<const Section> sections, std::span<const HeldBy> joints,
                   const LimbShape& shape);

} // namespace examples::anatomy

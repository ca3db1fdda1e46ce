#pragma once

#include "mesh.h"
#include "picture.h"
#include "skeleton.h"

#include <string>

namespace examples {

/// Light emitted by a surface: radiance is color times picture times strength.
struct Emission {
    glm::vec3 color{0}; ///< linear, 0..1
    float strength = 1;
    SharedPicture picture = nullptr;
};

/// A mesh of one material.
struct Part {
    std::string name;
    glm::vec3 color; ///< linear base color
    Mesh mesh;
    /// Transmitted fraction of light for a leaf or cloth, and its color. A part with a value above 0 is
    /// double-sided.
    float transmission = 0;
    glm::vec3 transmission_color{1};
    SharedPicture picture = nullptr; ///< times the base color
    Emission emission = {};
    float opacity = 1; ///< below 1 the part is blended
    SkinWeights skin = {};
};

/// Returns `part` with emission.
inline Part shining(Part part, const glm::vec3& color, float strength) {
    part.emission = {color, strength};
    return part;
}

/// A light of KHR_lights_punctual. The pictures show radiance 1 as white, and intensities are scaled
/// accordingly: an intensity of pi at a distance of 1 m makes white paper white.
struct GltfLight {
    std::string name;
    glm::vec3 position; ///< metres
    glm::vec3 color;    ///< linear, 0..1
    float intensity;    ///< candela, if radiance 1 is 1 cd/m²
    float range;        ///< metres
    /// Unit direction of a spot, and the angles of its cone from the axis, radians. Length 0: a point light.
    glm::vec3 direction{0};
    float inner_cone = 0, outer_cone = 0.78539816f;
};

/// Transform of a model: scaled, rotated about +Y (counter-clockwise seen from above), then moved.
struct Placement {
    glm::vec3 origin; ///< metres
    float degrees = 0;
    float scale = 1;
};

/// A mesh with many instances: EXT_mesh_gpu_instancing.
struct Model {
    std::string name;
    std::vector<Part> parts;
    std::vector<Placement> placements;
};

struct ExampleScene {
    std::vector<Part> parts;
    std::vector<GltfLight> lamps = {};
    Skeleton skeleton = {}; ///< skeleton of all parts; without joints they are static
    std::vector<Model> models = {};
};

ExampleScene torus_knot_over_plane();
ExampleScene room_with_columns();
/// Returns the room with columns with the minimum number of triangles that shows its shape.
ExampleScene plain_room();
/// The room with three lamps and a glowing sign.
ExampleScene night_room();
ExampleScene terrain();
/// Returns a tree in full leaf: light passes through the leaves.
ExampleScene tree();
/// A courtyard with arcades, an orange tree, a fountain, awnings and lanterns; at home from noon to night.
ExampleScene courtyard();
/// Returns a person of 1.8 m who looks along +Z and can walk: a skinned, animated mesh.
ExampleScene figure();
/// Some 15 000 buildings of 1.5 million vertices and 1.8 million triangles, to measure with.
ExampleScene city();
/// Trees of three kinds on a wavy meadow, some 600 vertices each, drawn as instances.
ExampleScene forest(int trees);
/// Houses of five kinds along both sides of a street, drawn as instances.
ExampleScene street(int houses);

} // namespace examples

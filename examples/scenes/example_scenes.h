#pragma once

#include "mesh.h"
#include "picture.h"
#include "skeleton.h"

#include <string>

namespace examples {

/// Light that a surface gives by itself: radiance is color times picture times strength.
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
    /// Of a leaf or cloth: the share of the light that passes, and its color. Above 0 the part is
    /// double-sided.
    float transmission = 0;
    glm::vec3 transmission_color{1};
    SharedPicture picture = nullptr; ///< times the base color
    Emission emission = {};
    float opacity = 1; ///< below 1 the part is blended
    SkinWeights skin = {};
};

/// `part` with light of its own.
inline Part shining(Part part, const glm::vec3& color, float strength) {
    part.emission = {color, strength};
    return part;
}

/// A light of KHR_lights_punctual. Our pictures show a radiance of 1 as white, so intensities are scaled like
/// that: an intensity of pi at a distance of 1 m makes white paper white.
struct Lamp {
    std::string name;
    glm::vec3 position; ///< metres
    glm::vec3 color;    ///< linear, 0..1
    float intensity;    ///< candela, if radiance 1 is 1 cd/m²
    float range;        ///< metres
    /// Of a spot, unit, and the angles of its cone from the axis, radians. Length 0: it shines all round.
    glm::vec3 direction{0};
    float inner_cone = 0, outer_cone = 0.78539816f;
};

/// Where a model stands: scaled, turned about +Y, counter-clockwise seen from above, then moved.
struct Placement {
    glm::vec3 origin; ///< metres
    float degrees = 0;
    float scale = 1;
};

/// A mesh that is drawn in many places: EXT_mesh_gpu_instancing.
struct Model {
    std::string name;
    std::vector<Part> parts;
    std::vector<Placement> placements;
};

struct ExampleScene {
    std::vector<Part> parts;
    std::vector<Lamp> lamps = {};
    Skeleton skeleton = {}; ///< that all parts hang on; without joints they stand still
    std::vector<Model> models = {};
};

ExampleScene torus_knot_over_plane();
ExampleScene room_with_columns();
/// The same of as few triangles as show its shape.
ExampleScene plain_room();
/// The room with three lamps and a glowing sign.
ExampleScene night_room();
ExampleScene terrain();
/// A tree in full leaf: light comes through the leaves.
ExampleScene tree();
/// A courtyard with arcades, an orange tree, a fountain, awnings and lanterns; at home from noon to night.
ExampleScene courtyard();
/// Somebody of 1.8 m who looks along +Z and can walk: a skinned, animated mesh.
ExampleScene figure();
/// Some 15 000 buildings of 1.5 million vertices and 1.8 million triangles, to measure with.
ExampleScene city();
/// Trees of three kinds on a wavy meadow, some 600 vertices each, drawn as instances.
ExampleScene forest(int trees);
/// Houses of five kinds along both sides of a street, drawn as instances.
ExampleScene street(int houses);

} // namespace examples

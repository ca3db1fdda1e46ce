// Colors and pictures of the courtyard's materials.
#include "materials.h"

#include "textures.h"

namespace examples {
namespace {

Part with_picture(Part part, SharedPicture picture, float metres) {
    part.mesh = with_scaled_texcoords(part.mesh, glm::vec2(1 / metres));
    part.picture = std::move(picture);
    return part;
}

} // namespace

ExampleScene finished(const Courtyard& c) {
    const SharedPicture plaster = plaster_picture(), leaf = leaf_picture();
    const glm::vec3 cream(0.8f, 0.74f, 0.6f), red(0.62f, 0.075f, 0.05f), blue(0.05f, 0.2f, 0.42f),
        saffron(0.9f, 0.47f, 0.08f);
    ExampleScene scene;
    std::vector<Part>& parts = scene.parts;
    parts = {
        with_picture({"paving", glm::vec3(1), c.building.paving}, paving_picture(), kPavingMetres),
        with_picture({"plaster", {0.86f, 0.66f, 0.4f}, c.building.plaster}, plaster, kPlasterMetres),
        with_picture({"garden wall", {0.85f, 0.8f, 0.7f}, c.building.garden_plaster}, plaster,
                     kPlasterMetres),
        with_picture({"stone", {0.72f, 0.66f, 0.55f}, c.building.stone}, stone_picture(), kStoneMetres),
        with_picture({"glazed tiles", glm::vec3(1), c.building.glazed_tiles}, glazed_tile_picture(),
                     kGlazedMetres),
        with_picture({"roof tiles", glm::vec3(1), c.building.roof_tiles}, roof_tile_picture(), 1),
        with_picture({"wood", {0.3f, 0.17f, 0.09f}, c.building.wood}, plank_picture(), kPlankMetres),
        with_picture({"painted wood", {0.07f, 0.3f, 0.31f}, c.building.painted_wood}, plank_picture(),
                     kPlankMetres),
        {"iron", {0.03f, 0.03f, 0.035f}, c.building.iron},
        {"panes", {0.04f, 0.05f, 0.06f}, c.glass.dark_panes},
        shining({"Window light", {0.25f, 0.2f, 0.14f}, c.glass.lit_panes}, {1, 0.6f, 0.24f}, 0.7f),
        {"water", {0.06f, 0.2f, 0.22f}, c.garden.water},
        {"clay", {0.5f, 0.22f, 0.11f}, c.garden.clay},
        {"soil", {0.08f, 0.055f, 0.04f}, c.garden.soil},
        with_picture({"red cloth", glm::vec3(1), c.cloth.red_cloth},
                     striped_picture("red stripes", red, cream), 1),
        with_picture({"blue cloth", glm::vec3(1), c.cloth.blue_cloth},
                     striped_picture("blue stripes", blue, cream), 1),
        with_picture({"thin cloth", glm::vec3(1), c.cloth.thin_cloth, 0.5f},
                     striped_picture("orange stripes", {0.8f, 0.22f, 0.02f}, cream), 1),
        {"saffron pennants", saffron, c.cloth.saffron_pennants, 0.5f, saffron},
        {"red pennants", red, c.cloth.red_pennants, 0.5f, red},
        {"blue pennants", blue, c.cloth.blue_pennants, 0.5f, blue},
        with_picture({"banner", glm::vec3(1), c.cloth.banner},
                     striped_picture("banner stripes", {0.45f, 0.03f, 0.09f}, saffron), 1),
        with_picture({"bark", glm::vec3(1), c.garden.bark}, bark_picture(), 1),
        with_picture({"orange leaves", {0.1f, 0.24f, 0.045f}, c.garden.leaves, 0.4f, {0.26f, 0.45f, 0.05f}},
                     leaf, 1),
        {"oranges", {0.85f, 0.3f, 0.02f}, c.garden.oranges},
        {"flowers", {0.68f, 0.06f, 0.3f}, c.garden.flowers, 0.4f, {0.8f, 0.1f, 0.4f}},
        with_picture({"vine leaves", {0.14f, 0.27f, 0.06f}, c.garden.vine_leaves, 0.4f, {0.3f, 0.45f, 0.08f}},
                     leaf, 1),
        shining({"Lantern glass", {0.1f, 0.06f, 0.02f}, c.glass.lantern_panes}, {1, 0.55f, 0.18f}, 3),
        shining({"Lantern flames", glm::vec3(0), c.glass.flames}, {1, 0.7f, 0.32f}, 20)};
    // Glass and flames hardly reflect: the lamp between them is so near that bounces would be noise.
    for (Part& part : parts)
        if (part.name == "Lantern glass")
            part.opacity = 0.3f;
    scene.lamps = c.lamps;
    return scene;
}

} // namespace examples

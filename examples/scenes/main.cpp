// Writes the example scenes and skies into a folder: example_scenes FOLDER [city]

#include "prt/image_file.h"
#include "sky_image.h"
#include "write_scene.h"

#include <glm/geometric.hpp>

#include <cstdio>
#include <exception>
#include <string_view>

int main(int argc, char** argv) {
    const bool with_city = argc == 3 && std::string_view(argv[2]) == "city";
    const bool help =
        argc == 2 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h");
    const bool option = argc == 2 && argv[1][0] == '-'; // a folder of such a name: ./-name
    if (help || option || (argc != 2 && !with_city)) {
        std::fprintf(help ? stdout : stderr, "usage: example_scenes FOLDER [city]\n");
        return help ? 0 : 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        std::filesystem::create_directories(folder);
        examples::write_scene(examples::torus_knot_over_plane(), folder / "knot.glb");
        examples::write_scene(examples::room_with_columns(), folder / "room.glb");
        examples::write_scene(examples::night_room(), folder / "night_room.glb");
        examples::write_scene(examples::courtyard(), folder / "courtyard.glb");
        examples::write_scene(examples::terrain(), folder / "terrain.glb");
        examples::write_scene(examples::tree(), folder / "tree.glb");
        if (with_city) // large, and only there to measure with
            examples::write_scene(examples::city(), folder / "city.glb");
        const auto write_sky = [&](const char* name, const prt::Environment& sky) {
            prt::write_exr(folder / name, sky.image, prt::EnvironmentLayout::lat_long);
        };
        write_sky("noon.exr", examples::sunny_sky(512, {.sun = glm::normalize(glm::dvec3(0.62, 0.9, 0.42))}));
        write_sky("evening.exr", examples::sunny_sky(512, {.sun = glm::normalize(glm::dvec3(0.9, 0.17, 0.5)),
                                                           .turbidity = 3.5,
                                                           .sun_to_sky = 1.8,
                                                           .white = 0.3}));
        write_sky("night.exr", examples::night_sky(512, glm::normalize(glm::dvec3(0.5, 0.8, 0.6))));
        write_sky("sky.exr", examples::preetham_sky(256, 3, glm::normalize(glm::dvec3(0.9, 0.75, 0.6))));
        std::printf("%s: knot, room, night_room, courtyard, terrain, tree%s (.glb); noon, evening, night, "
                    "sky (.exr)\n",
                    argv[1], with_city ? ", city" : "");
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "example_scenes: error: %s\n", error.what());
        return 1;
    }
}

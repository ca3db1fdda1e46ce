// Writes the example scenes and a sky into a folder: example_scenes FOLDER [city]

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
        examples::write_scene(examples::terrain(), folder / "terrain.glb");
        examples::write_scene(examples::tree(), folder / "tree.glb");
        if (with_city) // large, and only there to measure with
            examples::write_scene(examples::city(), folder / "city.glb");
        const prt::Environment sky =
            examples::preetham_sky(256, 3, glm::normalize(glm::dvec3(0.9, 0.75, 0.6)));
        prt::write_exr(folder / "sky.exr", sky.image, prt::EnvironmentLayout::lat_long);
        std::printf("%s: knot.glb, room.glb, terrain.glb, tree.glb, %ssky.exr\n", argv[1],
                    with_city ? "city.glb, " : "");
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "example_scenes: error: %s\n", error.what());
        return 1;
    }
}

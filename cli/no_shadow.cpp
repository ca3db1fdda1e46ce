// Marks materials that cast no shadow.

#include "no_shadow.h"

#include "prt/support/error.h"

namespace prt::cli {

void add_no_shadow(CLI::App* command, std::vector<std::string>& materials) {
    command
        ->add_option("--no-shadow", materials,
                     "name of a material that casts no shadow; repeat for several\n"
                     "for example a sky dome; default: all materials cast shadows\n"
                     "prt evaluate: the names that prt bake got; used by --measure budget and volume")
        ->allow_extra_args(false)
        ->type_name("MATERIAL");
}

void leave_out_shadows(Scene& scene, const std::vector<std::string>& materials) {
    for (const std::string& name : materials) {
        bool found = false;
        for (Material& material : scene.materials)
            if (material.name == name) {
                material.casts_shadow = false;
                found = true;
            }
        if (!found)
            throw Error("no material is called '" + name + "'");
    }
}

} // namespace prt::cli

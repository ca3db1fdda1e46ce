// Marks materials that cast no shadow.

#include "cli/pipeline/no_shadow.h"

#include "prt/core/error.h"

namespace prt::pipeline {

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

} // namespace prt::pipeline

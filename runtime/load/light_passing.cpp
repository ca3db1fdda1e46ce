// Transmission properties of materials.
#include "runtime/load/light_passing.h"

#include "prt/core/light.h"

#include <algorithm>
#include <cmath>

namespace prt {

float glass_transmittance(const Material& material) {
    const float tint = luminance(glm::vec3(material.base_color));
    return material.glass.factor * std::min(tint, 1.0f); // the luminance weights may round to a sum above 1
}

bool has_medium(const Material& material) {
    const MaterialVolume& volume = material.volume;
    return material.transmission.factor > 0 && volume.thickness > 0 &&
           std::isfinite(volume.attenuation_distance) && volume.attenuation_distance > 0;
}

bool lit_through_medium(const Material& material) {
    return material.volume.baked || has_medium(material);
}

void mark_media(Scene& scene, const BakeRecord& record) {
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        scene.materials[m].volume.baked =
            std::ranges::find(record.media, lamp_name(scene, m)) != record.media.end();
}

} // namespace prt

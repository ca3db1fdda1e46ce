// A person with animations for walking, standing and dancing. Limbs have elliptical sections around a
// skeleton.

#include "example_scenes.h"
#include "figure/body.h"
#include "figure/bones.h"
#include "figure/dance.h"
#include "figure/gait.h"

namespace examples {
namespace {

Part soft_part(std::string name, const glm::vec3& color, anatomy::SoftMesh soft) {
    Part part{std::move(name), color, std::move(soft.mesh)};
    part.skin = std::move(soft.skin);
    return part;
}

} // namespace

ExampleScene figure() {
    return {.parts = {soft_part("shirt", {0.62f, 0.24f, 0.13f}, anatomy::shirt()),
                      soft_part("dark", {0.11f, 0.14f, 0.21f}, anatomy::dark_parts()),
                      soft_part("skin", {0.72f, 0.50f, 0.38f}, anatomy::skin_parts())},
            .skeleton = {anatomy::joints(), {anatomy::walk(), anatomy::idle(), anatomy::dance()}}};
}

} // namespace examples

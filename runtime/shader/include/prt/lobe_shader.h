#pragma once

// The shaders of lobes as source text. Experimental.

#include "prt/lobes.h"
#include "prt/shader_source.h"

#include <glm/vec4.hpp>

#include <string>
#include <vector>

namespace prt {

/// Returns the lines of #define for shaders/prt_lobes.glsl. `light_order`: number of bands of the incident
/// light that the shader gets, 2..4; 0: the order of the model. Throws `Error` for any other `light_order`,
/// and the errors of `check_lobes`.
std::string lobe_defines(const LobeModel& model, int light_order = 0);

/// Returns the GLSL functions of lobes (shaders/prt_lobes.glsl), the same for every language. Insert them
/// after the version line of a shader, in ES after `precision highp float`. `behind`: source to put before
/// the functions. If `behind` is empty, the incident light has the order of the model. Otherwise `behind`
/// must be the result of `volume_functions`, and the incident light has the order of that volume. Throws the
/// errors of `check_lobes`.
std::string lobe_functions(const LobeModel& model, const std::string& behind = {});

/// Returns the content of the uniform block PrtLobeProfiles: [kMaxProfiles] the gains of bands 0 to 3 of each
/// profile. Entries beyond the profiles of the model are 0. `model` must be valid (`check_lobes`); this is
/// not checked.
std::vector<glm::vec4> lobe_profile_block(const LobeModel& model);

} // namespace prt

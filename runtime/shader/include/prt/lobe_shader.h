#pragma once

// The shaders of lobes as text. Experimental.

#include "prt/lobes.h"
#include "prt/shader_source.h"

#include <glm/vec4.hpp>

#include <string>
#include <vector>

namespace prt {

/// The lines that shaders/prt_lobes.glsl wants for a model. `light_order`: bands of the light that it will be
/// given, 2..4; 0: those of the model, or of the volume whose functions stand before. Throws `Error` for
/// another.
std::string lobe_defines(const LobeModel& model, int light_order = 0);

/// The functions for shaders of every language, to be put behind their version line (of ES: and `precision
/// highp float`). `behind`: what stands before them, as `volume_functions`, by whose light they are lit then.
std::string lobe_functions(const LobeModel& model, const std::string& behind = {});

/// The uniform block PrtLobeProfiles, PRT_MOST_PROFILES of four gains.
std::vector<glm::vec4> lobe_profile_block(const LobeModel& model);

} // namespace prt

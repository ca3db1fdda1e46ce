#pragma once

// The shaders of lobes as source text. Experimental.

#include "prt/lobes.h"
#include "prt/shader_source.h"

#include <glm/vec4.hpp>

#include <string>
#include <vector>

namespace prt {

/// Returns the define lines that shaders/prt_lobes.glsl needs for a model. `light_order`: number of bands of
/// the incident light, 2..4; 0: the order of the model. Throws `Error` for other values.
std::string lobe_defines(const LobeModel& model, int light_order = 0);

/// Returns the GLSL functions of lobes, for every language. Insert them after the version line (in ES also
/// after `precision highp float`). `behind`: source that is put before them, such as `volume_functions`. They
/// then use the incident light of the volume and its order. Without it the order of the light is that of the
/// model.
std::string lobe_functions(const LobeModel& model, const std::string& behind = {});

/// Returns the content of the uniform block PrtLobeProfiles: PRT_MAX_PROFILES entries of four gains.
std::vector<glm::vec4> lobe_profile_block(const LobeModel& model);

} // namespace prt

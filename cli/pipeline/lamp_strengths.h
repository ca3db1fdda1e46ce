#pragma once

// Strengths of the lamps of a model.

#include "prt/core/transfer.h"
#include "prt/load/scene.h"

#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt::pipeline {

/// Lamps as in the scene, off, or from a file.
struct LampChoice {
    bool on = true;
    /// {"NAME": strength or [red, green, blue], "*": strength of all others}
    std::filesystem::path file = {};
};

/// Multiplies the strengths of lamps that contain lights of `scene`; lamps of emissive materials are
/// unchanged.
void scale_lights(const Scene& scene, const TransferLayout& layout, double scale,
                  std::span<glm::vec3> strengths);

/// Computes the exit radiance of all receivers in a given light, and their areas.
struct Relit {
    const TransferLayout& layout;
    std::function<std::vector<glm::vec3>(const Lighting&)> radiance;
    std::span<const float> areas;
};
/// Keeps references to `transfer` and `areas`.
Relit relit_by(const Transfer& transfer, std::span<const float> areas, int threads);

/// Returns a notice that suggests --lamp-scale if the lights of `scene` are far brighter than the open sky,
/// as lights in candela and lux are. `lighting` contains sky and lamps; empty without a sky.
std::optional<std::string> photometric_notice(const Scene& scene, const Relit& model,
                                              const Lighting& lighting);

/// Returns the strengths, [layout.lamps()], of a JSON object as in LampChoice::file. Throws the errors of
/// `lamp_strengths`.
std::vector<glm::vec3> lamp_strengths_of(const nlohmann::ordered_json& object, const TransferLayout& layout);
/// Returns the strengths, [layout.lamps()]. Throws `Error` for a file that names no lamp of the layout, and
/// for strengths that are negative or not finite.
std::vector<glm::vec3> lamp_strengths(const LampChoice& lamps, const TransferLayout& layout);

} // namespace prt::pipeline

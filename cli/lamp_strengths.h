#pragma once

// How bright the lamps of a model are set.

#include "prt/scene.h"
#include "prt/transfer.h"

#include <CLI/CLI.hpp>
#include <glm/vec3.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt::cli {

/// As the scene has them, dark, or as a file says.
struct LampChoice {
    bool on = true;
    std::filesystem::path file = {}; ///< {"NAME": strength or [red, green, blue], "*": of all others}
};

/// --lamps
void add_lamps(CLI::App* command, LampChoice& lamps);

/// --lamp-scale: a factor on lights of KHR_lights_punctual.
void add_lamp_scale(CLI::App* command, double& scale);

/// Multiplies the strengths of lamps that hold lights of `scene`, not materials that shine alone.
void scale_lights(const Scene& scene, const TransferLayout& layout, double scale,
                  std::span<glm::vec3> strengths);

/// How to compute the exit radiance of all receivers in a given light, and their areas.
struct Relit {
    const TransferLayout& layout;
    std::function<std::vector<glm::vec3>(const Lighting&)> radiance;
    std::span<const float> areas;
};
/// Keeps references to `transfer` and `areas`.
Relit relit_by(const Transfer& transfer, std::span<const float> areas, int threads);

/// A line that suggests --lamp-scale where the lights of `scene` outshine the open sky as lights in candela
/// and lux do. `lighting`: sky and lamps; no sky, no line.
std::optional<std::string> photometric_notice(const Scene& scene, const Relit& model,
                                              const Lighting& lighting);

/// [layout.lamps()]. Throws `Error` for a file that names no lamp of the layout, and for strengths that are
/// negative or not finite.
std::vector<glm::vec3> lamp_strengths(const LampChoice& lamps, const TransferLayout& layout);

} // namespace prt::cli

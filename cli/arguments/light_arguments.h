#pragma once

// Options for lights: environments, suns and lamps.

#include "cli/pipeline/compress_metric.h"
#include "cli/pipeline/lamp_strengths.h"
#include "cli/pipeline/loaded_light.h"
#include "cli/program/session.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace prt::cli {

/// Line of help about files of light.
inline constexpr const char* kLightFiles =
    "FILE: environment image (.exr, .hdr, .png, .jpg) or light file (.json, from prt project)";
/// Line of help about suns of light files.
inline constexpr const char* kSunsOfLightFiles =
    "light file: 0: its suns are part of the sky; N from 1 and auto: all its suns are separate";
/// Adds --lights for commands that use several; `text` says what for.
CLI::Option* add_lights(CLI::App* command, std::vector<Path>& lights, const std::string& text);
/// Adds --lights for commands that use one light, which may be missing.
CLI::Option* add_light(CLI::App* command, Path& light);
/// Adds --window, --rotate, --env-layout, --layer and --bad-pixels. Notices about images are printed.
void add_light_options(CLI::App* command, LightOptions& options);
/// Throws `CLI::ValidationError` if an option of `add_light_options` is given without a light.
void check_light_options(const CLI::App& command, bool has_lights);

/// Adds --suns. `rays`: also adds its setting `rays`, the number of rays to each sun.
void add_suns(CLI::App* command, SunCount& suns, const std::string& text, const std::string& usual,
              int* rays = nullptr);

/// Adds --lamp-strengths.
void add_lamps(CLI::App* command, LampChoice& lamps);

/// Adds --lamp-scale: a factor on lights of KHR_lights_punctual. `details`: more lines of its help, each
/// after a newline.
void add_lamp_scale(CLI::App* command, double& scale, const std::string& details = "");

/// Adds --lights of `prt compress`, files or a family, with the options of `add_light_options`.
void add_metric(CLI::App* command, MetricArguments& arguments);

} // namespace prt::cli

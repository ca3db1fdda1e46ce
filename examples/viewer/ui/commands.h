#pragma once

// The table of all settings and keys. Keys, panel, scripts, the help and docs/viewer.md follow it.

#include "core/viewer.h"

#include <span>
#include <string_view>
#include <variant>

namespace viewer {

class Controls;

/// Pointer to a setting, by its type.
using SettingPointer = std::variant<PictureKind*, bool*, int*, float*>;

/// Range of a slider.
struct Range {
    float low = 0, high = 1;
    const char* format = "%.3f";
    bool logarithmic = false;
    bool strict = false; ///< values below `low` are invalid, also in scripts
};

struct Command {
    const char* id = "";    ///< id of a setting in scripts; empty: scripts press the key
    char key = 0;           ///< 0: none
    const char* help = "";  ///< help of the key; empty: another entry describes it
    const char* label = ""; ///< label in the panel
    const char* tip = "";   ///< tooltip in the panel
    SettingPointer (*setting)(Settings&) = nullptr; ///< returns the setting; null: the command has none
    void (*press)(Controls&) = nullptr;             ///< null: its key selects the next value of the setting
    Range range{};
};

/// Returns all commands in the order of the help.
std::span<const Command> commands();
/// Returns the setting with this `id`. Throws `prt::Error` if there is none.
const Command& setting(std::string_view id);

/// Selects the next value of a switch or a picture.
void switch_setting(const SettingPointer& setting);

} // namespace viewer

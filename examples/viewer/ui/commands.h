#pragma once

// The one table of what can be set and what keys do: keys, panel, scripts, the help and docs/viewer.md follow
// it.

#include "core/viewer.h"

#include <span>
#include <string_view>
#include <variant>

namespace viewer {

class Controls;

/// Where a setting is, by its type.
using Place = std::variant<PictureKind*, bool*, int*, float*>;

/// Of a slider.
struct Range {
    float low = 0, high = 1;
    const char* format = "%.3f";
    bool logarithmic = false;
    bool strict = false; ///< nothing below `low` makes sense, in scripts neither
};

struct Command {
    const char* id = "";                 ///< of a setting in scripts; empty: scripts press the key
    char key = 0;                        ///< 0: none
    const char* help = "";               ///< of the key; empty: another line says it
    const char* label = "";              ///< in the panel
    const char* tip = "";                ///< what the panel says of it
    Place (*place)(Settings&) = nullptr; ///< null: no setting
    void (*press)(Controls&) = nullptr;  ///< null: its key takes the next value of the setting
    Range range{};
};

/// In the order of the help.
std::span<const Command> commands();
/// The setting called `id`. Throws `prt::Error` where there is none.
const Command& setting(std::string_view id);

/// Takes the next value of a switch or a picture.
void switch_setting(const Place& place);

} // namespace viewer

#pragma once

// Parts of panels, for use within a window of Dear ImGui.

#include "ui/commands.h"

#include <functional>
#include <initializer_list>
#include <string>

namespace viewer {

/// Shows a tooltip for the previous control.
void tip(const char* text);
/// Shows a name and its value; `what` is its tooltip.
void line(const char* name, const std::string& value, const char* what = nullptr);
void check(const char* label, bool& value, const char* what);
/// Shows a tooltip with the reason why the previous control is disabled; does nothing if `reason` is empty.
void show_reason_disabled(const std::string& reason);
/// Shows a drop-down of pictures; those with a reason from `why_not` are disabled.
void choose_picture(const Command& command, PictureKind& kind,
                    const std::function<std::string(PictureKind)>& why_not);
/// Shows the control of a setting, as the table describes it.
void control(Settings& settings, const Command& command);
/// Shows the settings with these `ids` in one line.
void controls(Settings& settings, std::initializer_list<const char*> ids);

} // namespace viewer

#pragma once

// What panels are made of, within a window of Dear ImGui.

#include "ui/commands.h"

#include <functional>
#include <initializer_list>
#include <string>

namespace viewer {

/// Explains the control before it to a pointer that rests on it.
void tip(const char* text);
/// A name and its value; `what` explains it.
void line(const char* name, const std::string& value, const char* what = nullptr);
void check(const char* label, bool& value, const char* what);
/// Explains, to a pointer that rests on it, why the control before it is disabled; nothing where `reason` is
/// empty.
void say_why_disabled(const std::string& reason);
/// A drop-down of pictures; those for which `why_not` has a reason are disabled.
void choose_picture(const Command& command, PictureKind& kind,
                    const std::function<std::string(PictureKind)>& why_not);
/// What the table says of the setting.
void control(Settings& settings, const Command& command);
/// The settings called `ids`, in one line.
void controls(Settings& settings, std::initializer_list<const char*> ids);

} // namespace viewer

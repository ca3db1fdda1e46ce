#pragma once

// What panels are made of, within a window of Dear ImGui.

#include "ui/commands.h"

#include <initializer_list>
#include <string>

namespace viewer {

/// Explains the control before it to a pointer that rests on it.
void tip(const char* text);
/// A name and its value; `what` explains it.
void line(const char* name, const std::string& value, const char* what = nullptr);
void check(const char* label, bool& value, const char* what);
/// What the table says of the setting.
void control(Settings& settings, const Command& command);
/// The settings called `ids`, in one line.
void controls(Settings& settings, std::initializer_list<const char*> ids);

} // namespace viewer

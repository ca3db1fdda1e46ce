// Draws the parts of panels.

#include "ui/widgets.h"

#include "ui/overlay.h"

#include <imgui.h>
#include <imgui_internal.h>

namespace viewer {
void tip(const char* text) {
    constexpr float kRest = 0.35f; // seconds
    if (!ImGui::IsItemHovered() || ImGui::GetCurrentContext()->HoveredIdTimer < kRest)
        return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(scaled(320));
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void show_reason_disabled(const std::string& reason) {
    if (!reason.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", reason.c_str());
}

void choose_picture(const Command& command, PictureKind& kind,
                    const std::function<std::string(PictureKind)>& why_not) {
    if (!ImGui::BeginCombo(command.label, name_of(kind).title, ImGuiComboFlags_HeightLarge))
        return tip(command.tip);
    for (const PictureName& name : kPictures) {
        const std::string reason = why_not(name.kind);
        if (ImGui::Selectable(name.title, name.kind == kind,
                              reason.empty() ? 0 : ImGuiSelectableFlags_Disabled))
            kind = name.kind;
        show_reason_disabled(reason);
    }
    ImGui::EndCombo();
}

void line(const char* name, const std::string& value, const char* what) {
    ImGui::TextDisabled("%s", name);
    if (what && ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", what);
    ImGui::SameLine(scaled(150));
    ImGui::TextUnformatted(value.c_str());
}

void check(const char* label, bool& value, const char* what) {
    ImGui::Checkbox(label, &value);
    tip(what);
}

void control(Settings& settings, const Command& command) {
    const SettingPointer pointer = command.setting(settings);
    const Range& range = command.range;
    const ImGuiSliderFlags flags = (range.logarithmic ? ImGuiSliderFlags_Logarithmic : 0) |
                                   (range.strict ? ImGuiSliderFlags_AlwaysClamp : 0);
    if (PictureKind* const* kind = std::get_if<PictureKind*>(&pointer))
        return choose_picture(command, **kind, [](PictureKind) { return std::string(); });
    if (bool* const* value = std::get_if<bool*>(&pointer))
        ImGui::Checkbox(command.label, *value);
    else if (int* const* number = std::get_if<int*>(&pointer))
        ImGui::SliderInt(command.label, *number, static_cast<int>(range.low), static_cast<int>(range.high));
    else
        ImGui::SliderFloat(command.label, std::get<float*>(pointer), range.low, range.high, range.format,
                           flags);
    tip(command.tip);
}

void controls(Settings& settings, std::initializer_list<const char*> ids) {
    for (const char* const* id = ids.begin(); id != ids.end(); ++id) {
        if (id != ids.begin())
            ImGui::SameLine();
        control(settings, setting(*id));
    }
}

} // namespace viewer

// Draws the panel of the error budget.

#include "ui/budget_panel.h"

#include "core/budget_work.h"
#include "ui/overlay.h"
#include "ui/widgets.h"

#include "prt/tone_map.h"

#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace viewer {
namespace {

struct Row {
    prt::ErrorCause cause;
    const char* what;
    ImU32 color;
};
const std::array<Row, prt::kErrorCauses> kRows = {{
    {prt::ErrorCause::light, "What the bands of the order cannot hold of the light.",
     IM_COL32(240, 196, 60, 255)},
    {prt::ErrorCause::bounces, "Bounces that were not baked.", IM_COL32(226, 106, 60, 255)},
    {prt::ErrorCause::vertices, "Light between vertices is interpolated.", IM_COL32(96, 168, 224, 255)},
    {prt::ErrorCause::rays, "Noise of the bake, by a bake with another seed.", IM_COL32(150, 150, 160, 255)},
    {prt::ErrorCause::bytes, "What compression costs.", IM_COL32(126, 196, 108, 255)},
}};

std::string percent(double share) {
    return fmt::format("{:.2f} %", 100 * share);
}

/// Draws the shares of the squared errors next to each other.
void draw_bar(const prt::ErrorBudget& errors) {
    const ImVec2 at = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, scaled(14));
    double sum = 0;
    for (const prt::SquaredError& cause : errors.causes)
        sum += std::max(cause.value, 0.0);
    float left = at.x;
    for (const Row& row : kRows) {
        const double share = sum > 0 ? std::max(errors.of(row.cause).value, 0.0) / sum : 0;
        const float right = left + static_cast<float>(share) * size.x;
        ImGui::GetWindowDrawList()->AddRectFilled({left, at.y}, {right, at.y + size.y}, row.color);
        left = right;
    }
    ImGui::Dummy(size);
    tip("Squared errors of the causes, which add up to that of the total but for what they do to each "
        "other.");
}

void draw_row(const Row& row, const prt::SquaredError& error) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = ImGui::GetTextLineHeight() - scaled(4);
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + scaled(2)},
                                              {at.x + side, at.y + scaled(2) + side}, row.color);
    ImGui::SetCursorScreenPos({at.x + side + scaled(6), at.y});
    line(prt::to_string(row.cause), percent(error.root()), row.what);
}

void show_errors(const Viewer& viewer, const prt::ErrorBudget& errors) {
    draw_bar(errors);
    for (const Row& row : kRows)
        draw_row(row, errors.of(row.cause));
    line("total", percent(errors.total.root()),
         "Relative L2 of light all over the surface against path tracing.");
    line("its 95 % interval",
         fmt::format("{:.2f} .. {:.2f} %", 100 * std::sqrt(std::max(errors.total.low, 0.0)),
                     100 * std::sqrt(std::max(errors.total.high, 0.0))));
    if (!viewer.budget_is_current())
        ImGui::TextWrapped("Of another light or transfer: measure again.");
    if (any_shines(viewer.settings.lit.lamps))
        ImGui::TextWrapped("Without the light of lamps.");
}

} // namespace

void budget_panel(Viewer& viewer) {
    const Jobs& jobs = viewer.jobs();
    if (jobs.busy(JobKind::budget)) {
        ImGui::ProgressBar(static_cast<float>(jobs.share(JobKind::budget)), {-1, 0},
                           jobs.label(JobKind::budget).c_str());
        if (ImGui::SmallButton("stop"))
            viewer.stop_budget();
    } else if (viewer.can_measure()) {
        if (ImGui::SmallButton("measure"))
            viewer.measure_budget();
        tip("Takes the error over the surface apart by its causes, under this light, against path tracing.");
    } else {
        const bool of_texels = viewer.document().loaded.of_texels();
        ImGui::PushTextWrapPos();
        ImGui::TextDisabled("%s", of_texels ? kMeasuredOfVertices : "there is no bake to measure");
        ImGui::PopTextWrapPos();
    }
    if (viewer.document().budget)
        show_errors(viewer, viewer.document().budget->errors);
}

} // namespace viewer

// Draws the panel of the error budget.

#include "ui/budget_panel.h"

#include "core/budget_work.h"
#include "ui/overlay.h"
#include "ui/widgets.h"

#include "prt/render/tone_map.h"

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
    {prt::ErrorCause::light, "Light beyond the spherical harmonic bands of this order.",
     IM_COL32(240, 196, 60, 255)},
    {prt::ErrorCause::bounces, "Bounces that were not baked.", IM_COL32(226, 106, 60, 255)},
    {prt::ErrorCause::vertices, "Interpolation of light between vertices.", IM_COL32(96, 168, 224, 255)},
    {prt::ErrorCause::rays, "Noise of the bake, measured by a bake with another seed.",
     IM_COL32(150, 150, 160, 255)},
    {prt::ErrorCause::bytes, "Error of compression.", IM_COL32(126, 196, 108, 255)},
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
    tip("Squared errors by cause. Their sum differs from the total by their mutual "
        "effects.");
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
    line("total", percent(errors.total.root()), "Relative L2 error over the surface against path tracing.");
    line("95 % interval", fmt::format("{:.2f} .. {:.2f} %", 100 * std::sqrt(std::max(errors.total.low, 0.0)),
                                      100 * std::sqrt(std::max(errors.total.high, 0.0))));
    if (!viewer.budget_is_current())
        ImGui::TextWrapped("Measured with other light or transfer: measure again.");
    if (any_shines(viewer.settings.lit.lamps))
        ImGui::TextWrapped("Lamps are not included.");
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
        tip("Measures the error over the surface against path tracing under this light, by cause.");
    } else {
        const bool of_texels = viewer.document().loaded.of_texels();
        ImGui::PushTextWrapPos();
        ImGui::TextDisabled("%s", of_texels ? kMeasuredOfVertices : "no bake is open");
        ImGui::PopTextWrapPos();
    }
    if (viewer.document().budget)
        show_errors(viewer, viewer.document().budget->errors);
}

} // namespace viewer

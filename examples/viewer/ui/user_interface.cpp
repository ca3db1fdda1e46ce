// Sets up Dear ImGui and draws the panels.

#include "ui/user_interface.h"

#include "ui/panels.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <cmath>
#include <utility>

namespace viewer {

namespace {

constexpr float kFontPixels = 13;

} // namespace

UserInterface::UserInterface(GLFWwindow* window, float scale) : window_(window) {
    ImGui::CreateContext();
    ImFontConfig font;
    font.SizePixels = std::round(kFontPixels * scale);
    ImGui::GetIO().Fonts->AddFontDefault(&font);
    ImGui::GetIO().IniFilename = nullptr; // writes no file into the working directory
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4;
    ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.86f;
    ImGui::GetStyle().ScaleAllSizes(scale);
    if (window_)
        ImGui_ImplGlfw_InitForOpenGL(window_, false); // the window's callbacks call it
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

UserInterface::~UserInterface() {
    ImGui_ImplOpenGL3_Shutdown();
    if (window_)
        ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void UserInterface::draw(Viewer& viewer, std::uint32_t framebuffer, int width, int height) {
    ImGui_ImplOpenGL3_NewFrame();
    if (window_) {
        ImGui_ImplGlfw_NewFrame();
    } else {
        ImGui::GetIO().DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
        ImGui::GetIO().DeltaTime = 1.0f / 60;
    }
    ImGui::NewFrame();
    if (std::exchange(close_, false))
        close_topmost(viewer);
    draw_panels(viewer);
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void UserInterface::point(const glm::vec2& pixel) {
    ImGui::GetIO().MousePos = {pixel.x, pixel.y};
}

void UserInterface::press(bool down) {
    ImGui::GetIO().MouseDown[0] = down;
}

bool UserInterface::wants_pointer() const {
    return ImGui::GetIO().WantCaptureMouse;
}

bool UserInterface::wants_keyboard() const {
    return ImGui::GetIO().WantTextInput;
}

} // namespace viewer

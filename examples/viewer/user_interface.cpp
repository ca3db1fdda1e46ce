#include "user_interface.h"

#include "panels.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

namespace viewer {

UserInterface::UserInterface(GLFWwindow* window) : window_(window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // nothing is written where the viewer is started
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4;
    ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.86f;
    if (window_)
        ImGui_ImplGlfw_InitForOpenGL(window_, false); // our callbacks call it
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
    draw_panels(viewer);
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool UserInterface::wants_pointer() const {
    return ImGui::GetIO().WantCaptureMouse;
}

bool UserInterface::wants_keyboard() const {
    return ImGui::GetIO().WantTextInput;
}

} // namespace viewer

// Creates an offscreen framebuffer and saves screenshots.

#include "gpu/offscreen.h"

#include "prt/image/image_file.h"
#include "runtime/render/gl/gl_scene.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace viewer {

Offscreen::Offscreen(int width, int height)
    : width_(width), height_(height), color_(prt::make_texture_2d(1, GL_RGBA8, width, height)),
      depth_(prt::make_texture_2d(1, GL_DEPTH_COMPONENT24, width, height)) {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    framebuffer_ = prt::GlObject(prt::GlKind::framebuffer, name);
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, color_.name(), 0);
    glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth_.name(), 0);
}

void save_screenshot(std::uint32_t framebuffer, int width, int height, const std::filesystem::path& path) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    std::vector<glm::u8vec3> pixels(w * h);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    prt::check_gl("reading the picture back");
    for (std::size_t y = 0; y < h / 2; ++y) // OpenGL's first row is at the bottom
        std::swap_ranges(pixels.begin() + static_cast<std::ptrdiff_t>(y * w),
                         pixels.begin() + static_cast<std::ptrdiff_t>((y + 1) * w),
                         pixels.begin() + static_cast<std::ptrdiff_t>((h - 1 - y) * w));
    prt::write_png(path, width, height, pixels);
}

} // namespace viewer

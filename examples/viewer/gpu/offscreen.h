#pragma once

#include "prt/gl_objects.h"

#include <filesystem>

namespace viewer {

/// Something to draw on where there is no window, 8 bits with depth.
class Offscreen {
public:
    Offscreen(int width, int height);
    std::uint32_t framebuffer() const { return framebuffer_.name(); }
    int width() const { return width_; }
    int height() const { return height_; }

private:
    int width_, height_;
    prt::GlObject color_, depth_, framebuffer_;
};

/// What `framebuffer` shows, as a PNG. Throws `prt::Error` where it cannot be written.
void save_screenshot(std::uint32_t framebuffer, int width, int height, const std::filesystem::path& path);

} // namespace viewer

#pragma once

#include "runtime/render/gl/gl_objects.h"

#include <filesystem>

namespace viewer {

/// A framebuffer for drawing without a window, 8 bits per channel with depth.
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

/// Writes the content of `framebuffer` to a PNG. Throws `prt::Error` if the file cannot be written.
void save_screenshot(std::uint32_t framebuffer, int width, int height, const std::filesystem::path& path);

} // namespace viewer

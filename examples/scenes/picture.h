#pragma once

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace examples {

/// An image for a texture, 8 bits of sRGB per channel.
struct Picture {
    std::string name;
    int width = 0, height = 0;
    std::vector<glm::u8vec3> pixels; ///< [height][width], the topmost row first
};

/// A picture that several parts can share; it is identified by its name.
using SharedPicture = std::shared_ptr<const Picture>;

/// Returns a picture whose texels are the linear Rec. 709 color at their centers, with u to the right and v
/// downwards in [0, 1].
SharedPicture painted(const std::string& name, int width, int height,
                      const std::function<glm::vec3(float u, float v)>& color);

} // namespace examples

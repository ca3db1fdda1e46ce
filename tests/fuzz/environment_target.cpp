// An environment map of any kind is read and projected: OpenEXR, Radiance HDR, PNG, JPEG.
#include "input_file.h"

#include "prt/image/image_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace prt;
    static const fuzz::InputFile file("environment");
    if (size == 0)
        return 0;
    return fuzz::take([&] {
        EnvironmentOptions options;
        options.bad_pixels = data[size - 1] % 2 == 0 ? BadPixels::error : BadPixels::clamp;
        const EnvironmentFile read = load_environment(file.of(fuzz::bytes(data, size)), options);
        const Image& image = read.environment.image;
        fuzz::expect(image.pixels.size() ==
                         static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
                     "an image has another number of pixels than it says");
        for (const glm::vec3& pixel : image.pixels)
            fuzz::expect_finite(std::span<const float>(&pixel.x, 3), "pixels");
        for (const glm::vec3& coefficient : project(read.environment, 2, 1).coefficients)
            fuzz::expect_finite(std::span<const float>(&coefficient.x, 3), "projected light");
    });
}

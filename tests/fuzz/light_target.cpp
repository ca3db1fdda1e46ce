// A light file of prt project is read.
#include "input_file.h"

#include "prt/load/light_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace prt;
    static const fuzz::InputFile file("light.json");
    return fuzz::take([&] {
        const Light light = all_light(read_light_file(file.of(fuzz::bytes(data, size))));
        fuzz::expect(light.coefficients.size() == static_cast<std::size_t>(light.order * light.order),
                     "a light has another number of coefficients than its order");
        for (const glm::vec3& coefficient : light.coefficients)
            fuzz::expect_finite(std::span<const float>(&coefficient.x, 3), "a light");
    });
}

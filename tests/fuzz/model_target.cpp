// A .gltf or .glb is read: the scene in it, transfer, clustered transfer; and lit.
#include "input_file.h"
#include "whole_model.h"

#include "prt/constant_former.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace prt;
    static const fuzz::InputFile file("model.glb");
    return fuzz::take([&] {
        const fuzz::WholeModel model = fuzz::read_whole(fuzz::bytes(data, size), file.path());
        if (!model.compressed)
            return;
        const ClusteredTransfer& transfer = model.compressed->transfer;
        fuzz::expect_finite(std::span<const float>(decode(transfer, 1).vectors), "decoded transfer");
        const Light light = constant_light(transfer.bases.layout.order, glm::vec3(1));
        for (const glm::vec3& radiance : exit_radiance(transfer, light, 1))
            fuzz::expect_finite(std::span<const float>(&radiance.x, 3), "exit radiance");
    });
}

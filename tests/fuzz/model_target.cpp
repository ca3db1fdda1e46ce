// A .gltf or .glb is read as a game and as the program do: the scene in it, transfer, clustered transfer; and
// lit.
#include "input_file.h"
#include "whole_model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace prt;
    static const fuzz::InputFile file("model.glb");
    fuzz::take([&] { fuzz::use_loaded(fuzz::bytes(data, size), file.path()); });
    return fuzz::take([&] {
        const fuzz::WholeModel model = fuzz::read_whole(fuzz::bytes(data, size), file.path());
        if (model.compressed)
            fuzz::expect_finite_light(model.compressed->transfer);
        if (model.lightmap)
            fuzz::expect_finite_light(*model.lightmap);
    });
}

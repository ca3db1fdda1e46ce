// Decodes one compressed buffer view: the first byte selects mode, filter and stride, two more the number of
// elements, the rest is the data.
#include "input_file.h"

#include "prt/gltf/gltf.h"
#include "support/glb_file.h"

namespace prt::fuzz {
namespace {

std::string compressed_view_file(std::span<const std::byte> input) {
    constexpr const char* kModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES", "ATTRIBUTES"};
    constexpr const char* kFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    const auto choice = static_cast<unsigned>(input[0]);
    const auto count = static_cast<unsigned>(input[1]) + 256 * static_cast<unsigned>(input[2]);
    const unsigned mode = choice % 4, filter = choice / 4 % 4, width = choice / 16;
    const unsigned stride = mode == 0 || mode == 3 ? 4 * (width + 1) : 2 + 2 * (width % 2);
    test::GlbFile file;
    const std::span<const std::byte> data = input.subspan(3);
    const std::size_t view = file.view(data);
    file.json["bufferViews"][view]["byteLength"] = count * stride;
    file.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0},          {"byteOffset", 0}, {"byteLength", data.size()}, {"byteStride", stride},
        {"mode", kModes[mode]}, {"count", count},  {"filter", kFilters[filter]}};
    return file.bytes();
}

} // namespace
} // namespace prt::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace prt;
    if (size < 4)
        return 0;
    const std::string file = fuzz::compressed_view_file(fuzz::bytes(data, size));
    return fuzz::take([&] { parse_gltf(std::as_bytes(std::span(file)), "views.glb"); });
}

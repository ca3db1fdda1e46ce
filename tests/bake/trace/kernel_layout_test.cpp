// Structs that kernels and C++ share: the offsets that the compiled kernels read them at.

#include "shared_structs.h"

#include "kernels/bake_accumulate.h"
#include "kernels/bake_gather.h"
#include "kernels/bake_lamps.h"
#include "kernels/bake_trace.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <span>
#include <string>

namespace prt {
namespace {

/// Returns offsets by "Struct.member", and strides of arrays by "Struct", read from SPIR-V (its
/// specification, section 3).
std::map<std::string, std::uint32_t> layout_of(std::span<const std::uint32_t> spirv) {
    enum : std::uint32_t {
        name = 5,
        member_name = 6,
        runtime_array = 29,
        decorate = 71,
        member_decorate = 72
    };
    enum : std::uint32_t { array_stride = 6, offset = 35 };
    std::map<std::uint32_t, std::string> names;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> members;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> offsets;
    std::map<std::uint32_t, std::uint32_t> strides, elements;
    for (std::size_t at = 5; at < spirv.size(); at += spirv[at] >> 16) {
        const std::uint32_t* const word = &spirv[at];
        const std::uint32_t operation = word[0] & 0xffff;
        if (operation == name)
            names[word[1]] = reinterpret_cast<const char*>(&word[2]);
        else if (operation == member_name)
            members[{word[1], word[2]}] = reinterpret_cast<const char*>(&word[3]);
        else if (operation == member_decorate && word[3] == offset)
            offsets[{word[1], word[2]}] = word[4];
        else if (operation == decorate && word[2] == array_stride)
            strides[word[1]] = word[3];
        else if (operation == runtime_array)
            elements[word[1]] = word[2];
    }
    std::map<std::string, std::uint32_t> layout;
    for (const auto& [member, at] : offsets)
        layout[names[member.first] + "." + members[member]] = at;
    for (const auto& [array, element] : elements)
        if (!names[element].empty())
            layout[names[element]] = strides[array];
    return layout;
}

TEST(GpuStructs, HaveTheMemoryLayoutOfKernels) {
    const std::map<std::string, std::uint32_t> trace = layout_of(bake_trace), lamps = layout_of(bake_lamps);
    const std::map<std::string, std::size_t> in_trace = {
        {"Receiver", sizeof(gpu::Receiver)},
        {"Receiver.normal", offsetof(gpu::Receiver, normal)},
        {"HitRecord", sizeof(gpu::HitRecord)},
        {"HitRecord.row", offsetof(gpu::HitRecord, row)},
        {"ThreadProgress", sizeof(gpu::ThreadProgress)},
        {"ThreadProgress.left", offsetof(gpu::ThreadProgress, left)},
        {"AlphaTriangle", sizeof(gpu::AlphaTriangle)},
        {"AlphaTriangle.next", offsetof(gpu::AlphaTriangle, next)},
        {"AlphaMaterial", sizeof(gpu::AlphaMaterial)},
        {"AlphaMaterial.wrap", offsetof(gpu::AlphaMaterial, wrap)},
        {"WideNode", sizeof(gpu::WideNode)},
        {"WideNode.high", offsetof(gpu::WideNode, high)},
        {"TracePush.spread", offsetof(gpu::TracePush, spread)}};
    const std::map<std::string, std::size_t> in_lamps = {
        {"LampReceiver", sizeof(gpu::LampReceiver)},
        {"LampReceiver.position", offsetof(gpu::LampReceiver, position)},
        {"PunctualLight", sizeof(gpu::PunctualLight)},
        {"PunctualLight.outer_cosine", offsetof(gpu::PunctualLight, outer_cosine)},
        {"ShiningTriangle", sizeof(gpu::ShiningTriangle)},
        {"ShiningTriangle.image", offsetof(gpu::ShiningTriangle, image)},
        {"EmissionImage", sizeof(gpu::EmissionImage)},
        {"EmissionImage.linear", offsetof(gpu::EmissionImage, linear)},
        {"LampPush.nearest", offsetof(gpu::LampPush, nearest)}};
    const std::map<std::string, std::size_t> in_sums = {{"SumRow", sizeof(gpu::SumRow)},
                                                        {"SumRow.shares", offsetof(gpu::SumRow, shares)},
                                                        {"SumRow.sign", offsetof(gpu::SumRow, sign)}};
    const std::map<std::string, std::uint32_t> accumulate = layout_of(bake_accumulate),
                                               gather = layout_of(bake_gather);
    for (const auto& [what, point] : in_sums) {
        EXPECT_EQ(accumulate.at(what), point) << what;
        EXPECT_EQ(gather.at(what), point) << what;
    }
    EXPECT_EQ(gather.at("GatherPush.largest"), offsetof(gpu::GatherPush, largest));
    for (const auto& [what, point] : in_trace)
        EXPECT_EQ(trace.at(what), point) << what;
    for (const auto& [what, point] : in_lamps)
        EXPECT_EQ(lamps.at(what), point) << what;
}

} // namespace
} // namespace prt

// Reads and writes the container of .glb files: a header and two chunks (glTF 2.0, section 4).
#include "runtime/load/glb.h"

#include "prt/core/error.h"

#include <cstdint>
#include <cstring>

namespace prt {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBin = 0x004E4942;
constexpr std::size_t kHeader = 12, kChunkHeader = 8;

std::uint32_t word(std::span<const std::byte> file, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + offset, sizeof value);
    return value;
}

void append_word(std::vector<std::byte>& file, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    const auto* bytes = reinterpret_cast<const std::byte*>(&word);
    file.insert(file.end(), bytes, bytes + sizeof word);
}

} // namespace

bool is_glb(std::span<const std::byte> file) {
    return file.size() >= sizeof kMagic && word(file, 0) == kMagic;
}

std::string_view glb_json(std::span<const std::byte> file) {
    if (file.size() < kHeader + kChunkHeader)
        throw Error("is truncated: it ends inside the GLB header");
    if (word(file, 4) != 2)
        throw Error("is a GLB of version " + std::to_string(word(file, 4)) + "; only version 2 is supported");
    const std::uint32_t total = word(file, 8), length = word(file, kHeader);
    if (total > file.size())
        throw Error("is truncated: the GLB header declares " + std::to_string(total) +
                    " bytes, but the file has " + std::to_string(file.size()));
    if (word(file, kHeader + 4) != kJson)
        throw Error("its first GLB chunk is not JSON");
    if (length > file.size() - kHeader - kChunkHeader)
        throw Error("is truncated: its JSON chunk reaches beyond the end of the file");
    return {reinterpret_cast<const char*>(file.data()) + kHeader + kChunkHeader, length};
}

std::span<const std::byte> glb_binary(std::span<const std::byte> file) {
    std::size_t begin = kHeader + kChunkHeader + glb_json(file).size();
    while (file.size() >= begin + kChunkHeader) {
        const std::size_t length = word(file, begin);
        if (length > file.size() - begin - kChunkHeader)
            throw Error("is truncated: its binary chunk reaches beyond the end of the file");
        if (word(file, begin + 4) == kBin)
            return file.subspan(begin + kChunkHeader, length);
        begin += kChunkHeader + length; // readers ignore unknown chunks
    }
    return {};
}

std::vector<std::byte> make_glb(std::string json, std::span<const std::byte> binary) {
    json.append((4 - json.size() % 4) % 4, ' ');
    const std::size_t padding = (4 - binary.size() % 4) % 4;
    const std::size_t binary_chunk = binary.empty() ? 0 : kChunkHeader + binary.size() + padding;
    const std::size_t total = kHeader + kChunkHeader + json.size() + binary_chunk;
    if (total > UINT32_MAX)
        throw Error("the output has " + std::to_string(total) + " bytes, but a .glb file is limited to 4 GB");
    std::vector<std::byte> file;
    file.reserve(total);
    for (const std::size_t value :
         {std::size_t{kMagic}, std::size_t{2}, total, json.size(), std::size_t{kJson}})
        append_word(file, value);
    const auto* text = reinterpret_cast<const std::byte*>(json.data());
    file.insert(file.end(), text, text + json.size());
    if (!binary.empty()) {
        append_word(file, binary.size() + padding);
        append_word(file, kBin);
        file.insert(file.end(), binary.begin(), binary.end());
        file.resize(total);
    }
    return file;
}

} // namespace prt

// Mutates models in effective positions: a member of the JSON, its text, or the binary chunk. Then it
// rebuilds the container, because random bytes would break its lengths at once.
#include "runtime/load/glb.h"
#include "target.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace prt::fuzz {
namespace {

using Json = nlohmann::ordered_json;

void collect(Json& value, std::vector<Json*>& all) {
    all.push_back(&value);
    if (value.is_structured())
        for (Json& member : value)
            collect(member, all);
}

Json strange_number(std::mt19937& random) {
    const Json numbers[] = {0,           1,
                            2,           3,
                            4,           5,
                            7,           8,
                            16,          255,
                            256,         1023,
                            65535,       65536,
                            5120,        5121,
                            5123,        5125,
                            5126,        5131,
                            -1,          2147483647,
                            2147483648u, 4294967295u,
                            4294967296,  -2147483648ll,
                            0.5,         -0.0,
                            1e-30,       1e18,
                            3e38,        1e300};
    return numbers[random() % std::size(numbers)];
}

/// One change to one value anywhere in `json`.
void change_member(Json& json, std::mt19937& random) {
    std::vector<Json*> all;
    collect(json, all);
    Json& value = *all[random() % all.size()];
    const Json other = *all[random() % all.size()];
    switch (random() % 5) {
    case 0:
        value = other;
        break;
    case 1:
        if (value.is_structured() && !value.empty()) {
            const auto at = std::next(value.begin(), static_cast<std::ptrdiff_t>(random() % value.size()));
            value.erase(at);
            break;
        }
        [[fallthrough]];
    case 2:
        if (value.is_array()) {
            value.push_back(value.empty() ? other : Json(value[random() % value.size()]));
            break;
        }
        [[fallthrough]];
    default:
        value = value.is_number_integer() && random() % 2
                    ? Json(value.get<std::int64_t>() + (random() % 2 ? 1 : -1))
                    : strange_number(random);
    }
}

/// Whether recursion over the text's members is safe.
bool flat_enough(std::string_view text) {
    return std::count_if(text.begin(), text.end(), [](char c) { return c == '[' || c == '{'; }) < 2000;
}

template <class Bytes>
void mutate_bytes(Bytes& bytes, std::size_t most) {
    const std::size_t size = bytes.size();
    bytes.resize(std::max(size, most));
    bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, bytes.size()));
}

std::vector<std::byte> mutated(std::span<const std::byte> file, std::size_t most, unsigned seed) {
    std::mt19937 random(seed);
    std::string text(glb_json(file));
    const auto chunk = glb_binary(file);
    std::vector<std::byte> binary(chunk.begin(), chunk.end());
    const unsigned kind = random() % 6;
    if (kind == 0)
        mutate_bytes(text, most - std::min(most, file.size()) + text.size());
    else if (kind == 1)
        mutate_bytes(binary, most - std::min(most, file.size()) + binary.size());
    else if (Json json = flat_enough(text) ? Json::parse(text, nullptr, false) : Json(); json.is_object())
        for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
            change_member(json, random);
            text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
        }
    return make_glb(text, binary);
}

} // namespace
} // namespace prt::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
    const auto file = prt::fuzz::bytes(data, size);
    if (seed % 8 != 0 && prt::is_glb(file))
        try {
            const std::vector<std::byte> changed = prt::fuzz::mutated(file, most, seed);
            if (changed.size() <= most) {
                std::memcpy(data, changed.data(), changed.size());
                return changed.size();
            }
        } catch (const prt::Error&) { // no container to keep
        }
    return LLVMFuzzerMutate(data, size, most);
}

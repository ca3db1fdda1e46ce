// Damages shipped files at random positions.

#include "damage.h"

#include "prt/image/image_file.h"
#include "support/lightmap_model.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace prt::test {
namespace {

using Json = nlohmann::ordered_json;
using Random = std::mt19937;

std::size_t below(std::size_t count, Random& random) {
    return count == 0 ? 0 : random() % count;
}

/// Returns numbers that are invalid, or barely valid, as counts, bits, scales and indices.
Json strange_number(Random& random) {
    static const Json kNumbers = {
        0,          1,          2,      3,     7,           15,     16,
        17,         255,        256,    601,   65535,       65536,  65537,
        2147483647, 4294967295, -1,     -2,    -128,        -65536, 0.5,
        -0.0,       1e-45,      1e-300, 1e9,   1.0000001e9, -1e9,   1e15,
        1e18,       1e30,       3e38,   -3e38, 1e39,        1e300,  9007199254740993,
        nullptr}; // JSON replaces NaN and infinity by null
    return kNumbers[below(kNumbers.size(), random)];
}

Json strange_value(Random& random) {
    static const Json kValues = {
        nullptr,       true,           "",        "normal",  "position",    "tangent",
        Json::array(), Json::object(), {1, 2, 3}, {0, 0, 0}, {1e300, 1, 1}, {{"bufferView", 0}}};
    return random() % 2 ? strange_number(random) : kValues[below(kValues.size(), random)];
}

void collect(Json& value, std::vector<Json*>& all) {
    all.push_back(&value);
    if (value.is_structured())
        for (Json& member : value)
            collect(member, all);
}

/// Returns a random member; short and long lists of the extension have equal probability.
Json& member_of(Json& value, Random& random) {
    Json* at = &value;
    while (at->is_structured() && !at->empty() && random() % 5 != 0)
        at = &*std::next(at->begin(), static_cast<std::ptrdiff_t>(below(at->size(), random)));
    return *at;
}

Json& extension(GlbFile& file) {
    return file.json["extensions"]["PRTKIT_transfer"]["sets"][0];
}

void change_number(GlbFile& file, Random& random) {
    std::vector<Json*> all, numbers;
    collect(extension(file), all);
    for (Json* value : all)
        if (value->is_number())
            numbers.push_back(value);
    Json& value = random() % 2 || numbers.empty() ? member_of(extension(file), random)
                                                  : *numbers[below(numbers.size(), random)];
    const double old = value.is_number() ? value.get<double>() : 0;
    switch (random() % 4) {
    case 0:
        value = value.is_number_integer() ? Json(value.get<std::int64_t>() + (random() % 2 ? 1 : -1))
                                          : Json(2 * old);
        break;
    case 1:
        value = -old;
        break;
    default:
        value = strange_number(random);
    }
}

void change_value(GlbFile& file, Random& random) {
    member_of(extension(file), random) = strange_value(random);
}

void remove_member(GlbFile& file, Random& random) {
    for (int tries = 0; tries < 20; ++tries) {
        Json& value = member_of(extension(file), random);
        if (!value.is_structured() || value.empty())
            continue;
        value.erase(std::next(value.begin(), static_cast<std::ptrdiff_t>(below(value.size(), random))));
        return;
    }
}

void lengthen_list(GlbFile& file, Random& random) {
    constexpr std::array<std::size_t, 5> kCounts = {1, 2, 100, 70'000, 200'000};
    for (int tries = 0; tries < 20; ++tries) {
        Json& value = member_of(extension(file), random);
        if (!value.is_array())
            continue;
        const Json again = value.empty() ? strange_number(random) : Json(value[below(value.size(), random)]);
        if (again.is_structured()) {
            value.push_back(again);
            return;
        }
        for (std::size_t i = kCounts[below(kCounts.size(), random)]; i > 0; --i)
            value.push_back(again);
        return;
    }
}

/// Changes sizes and words of maps, pixels of images, and map references of primitives.
void change_maps(GlbFile& file, Random& random) {
    Json& maps = extension(file).at("maps");
    Json& map = maps[below(maps.size(), random)];
    Json& image = map["images"][below(map["images"].size(), random)];
    switch (random() % 7) {
    case 0:
        map[random() % 2 ? "width" : "height"] = strange_number(random);
        break;
    case 1:
        image = random() % 2 ? Json(below(file.json["images"].size(), random)) : strange_value(random);
        break;
    case 2:
        map["images"].push_back(image);
        break;
    case 3:
        map["repeats"] = random() % 2 ? Json(!map.value("repeats", false)) : strange_value(random);
        break;
    case 4: {
        std::vector<glm::u8vec4> pixels(map["width"].get<std::size_t>() * map["height"].get<std::size_t>());
        for (glm::u8vec4& pixel : pixels)
            pixel = {random() % 256, random() % 256, random() % 256, random() % 256};
        image = add_image(file, encode_png(map["width"], map["height"], pixels));
        break;
    }
    case 5:
        maps.push_back(map);
        break;
    default: {
        Json& primitives = file.json["meshes"][0]["primitives"];
        primitives[below(primitives.size(), random)]["extensions"]["PRTKIT_transfer"]
                  [random() % 2 ? "map" : "texCoord"] = strange_value(random);
    }
    }
}

void change_predictors(GlbFile& file, Random& random) {
    if (extension(file).contains("maps"))
        return change_maps(file, random);
    Json& predictors = extension(file)["predictors"];
    if (!predictors.is_array() || predictors.empty()) {
        predictors = Json::array({{{"kind", "normal"}, {"scale", {1, 1, 1}}}});
        return;
    }
    Json& predictor = predictors[below(predictors.size(), random)];
    switch (random() % 6) {
    case 0:
        predictor["kind"] = strange_value(random);
        break;
    case 1:
        predictors.push_back(predictor);
        break;
    case 2:
        predictor["scale"][below(4, random)] = strange_number(random);
        break;
    case 3:
        predictor["origin"] = {strange_number(random), 0, strange_number(random)};
        break;
    case 4:
        predictors.erase(below(predictors.size(), random));
        break;
    default:
        predictor.erase("origin");
    }
}

/// Returns the existing bytes of a view.
std::span<std::byte> view_bytes(GlbFile& file, std::size_t view) {
    const Json& json = file.json["bufferViews"].at(view);
    const std::size_t size = file.binary.size(),
                      begin = std::min<std::size_t>(json.value("byteOffset", 0u), size);
    return std::span(file.binary)
        .subspan(begin, std::min<std::size_t>(json.value("byteLength", 0u), size - begin));
}

/// Returns a view or an image with words that the extension references.
std::size_t own_view(GlbFile& file, Random& random) {
    std::vector<Json*> all;
    std::vector<std::size_t> views;
    collect(extension(file), all);
    if (file.json.contains("images"))
        for (Json& image : file.json["images"])
            all.push_back(&image);
    for (const Json* value : all)
        if (value->is_object() && value->contains("bufferView") &&
            (*value)["bufferView"].is_number_unsigned())
            if (const std::size_t view = (*value)["bufferView"]; view < file.json["bufferViews"].size())
                views.push_back(view);
    return views.empty() ? 0 : views[below(views.size(), random)];
}

void change_own_bytes(GlbFile& file, Random& random) {
    const std::span<std::byte> bytes = view_bytes(file, own_view(file, random));
    for (std::size_t n = std::size_t{1} << below(6, random); n > 0 && !bytes.empty(); --n)
        bytes[below(bytes.size(), random)] = static_cast<std::byte>(random() % 2 ? 0xff : random() % 256);
}

constexpr std::array<float, 12> kStrangeFloats = {std::numeric_limits<float>::quiet_NaN(),
                                                  std::numeric_limits<float>::infinity(),
                                                  -std::numeric_limits<float>::infinity(),
                                                  std::numeric_limits<float>::max(),
                                                  std::numeric_limits<float>::denorm_min(),
                                                  0.0f,
                                                  -0.0f,
                                                  1e6f,
                                                  -1.0001e6f,
                                                  1e9f,
                                                  1e18f,
                                                  1e-30f};

void put_strange_floats(std::span<std::byte> bytes, Random& random) {
    const float value = kStrangeFloats[below(kStrangeFloats.size(), random)];
    const std::size_t floats = bytes.size() / sizeof value;
    if (floats == 0)
        return;
    for (std::size_t n = random() % 3 == 0 ? floats : 1; n > 0; --n) {
        const std::size_t at = n == floats ? n - 1 : below(floats, random);
        std::memcpy(&bytes[at * sizeof value], &value, sizeof value);
    }
}

void change_own_floats(GlbFile& file, Random& random) {
    put_strange_floats(view_bytes(file, own_view(file, random)), random);
}

/// Shortens and moves views, so that they overlap or leave the buffer.
void change_view(GlbFile& file, Random& random) {
    const std::size_t at =
        random() % 3 ? own_view(file, random) : below(file.json["bufferViews"].size(), random);
    Json& view = file.json["bufferViews"][at];
    const Json& other = file.json["bufferViews"][below(file.json["bufferViews"].size(), random)];
    switch (random() % 5) {
    case 0:
        view["byteLength"] = below(view.value("byteLength", 1u) + 1, random);
        break;
    case 1:
        view["byteOffset"] = other.value("byteOffset", 0u);
        break;
    case 2:
        view = Json(other);
        break;
    case 3:
        view[random() % 2 ? "byteLength" : "byteOffset"] = strange_number(random);
        break;
    default:
        view["byteStride"] = strange_number(random);
    }
}

Json& primitive(GlbFile& file, Random& random) {
    Json& primitives = file.json["meshes"][below(file.json["meshes"].size(), random)]["primitives"];
    return primitives[below(primitives.size(), random)];
}

void change_accessor(GlbFile& file, Random& random) {
    Json& accessor = file.json["accessors"][below(file.json["accessors"].size(), random)];
    switch (random() % 6) {
    case 0:
        accessor["count"] = accessor.value("count", 0) + (random() % 2 ? 1 : -1);
        break;
    case 1:
        accessor["count"] = strange_number(random);
        break;
    case 2:
        accessor["componentType"] = 5120 + static_cast<int>(random() % 7);
        break;
    case 3:
        accessor["type"] = std::array{"SCALAR", "VEC2", "VEC3", "VEC4", "MAT4", "VEC5"}[random() % 6];
        break;
    case 4:
        accessor.erase("bufferView");
        break;
    default:
        accessor["normalized"] = strange_value(random);
    }
}

void change_attributes(GlbFile& file, Random& random) {
    Json& attributes = primitive(file, random)["attributes"];
    const auto at =
        std::next(attributes.begin(), static_cast<std::ptrdiff_t>(below(attributes.size(), random)));
    if (random() % 2)
        attributes.erase(at);
    else
        *at = random() % 2 ? Json(below(file.json["accessors"].size(), random)) : strange_value(random);
}

/// Replaces normals and positions by values that are not finite, zero, tiny, huge or negated.
void change_vertices(GlbFile& file, Random& random) {
    const Json& attributes = primitive(file, random)["attributes"];
    const char* name = random() % 3 && attributes.contains("NORMAL") ? "NORMAL" : "POSITION";
    if (!attributes.contains(name))
        return;
    const Json& accessor = file.json["accessors"].at(attributes[name].get<std::size_t>());
    const std::span<std::byte> bytes = view_bytes(file, accessor.value("bufferView", std::size_t{0}));
    if (accessor["componentType"] != kFloat) {
        for (std::byte& byte : bytes)
            byte = random() % 2 ? std::byte{0x80} : std::byte{0};
    } else if (random() % 4 == 0) {
        for (std::size_t i = 3; i < bytes.size(); i += 4)
            bytes[i] ^= std::byte{0x80}; // the sign
    } else {
        put_strange_floats(bytes, random);
    }
}

void change_node(GlbFile& file, Random& random) {
    Json& node = file.json["nodes"][below(file.json["nodes"].size(), random)];
    switch (random() % 3) {
    case 0:
        node["scale"] = {strange_number(random), 1, random() % 2 ? 0 : 1};
        break;
    case 1:
        node["translation"] = {strange_number(random), strange_number(random), 0};
        break;
    default:
        node.erase("scale");
        node.erase("rotation");
        node.erase("translation");
        node["matrix"] = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, strange_number(random), 0, 0, 0, 0, 1};
    }
}

void cut_binary(GlbFile& file, Random& random) {
    file.binary.resize(below(file.binary.size() + 1, random));
    if (random() % 2)
        file.json.erase("buffers");
}

} // namespace

GlbFile damaged(GlbFile file, std::uint32_t seed) {
    using Change = void (*)(GlbFile&, Random&);
    constexpr Change kChanges[] = {change_number,     change_number,     change_value,      remove_member,
                                   lengthen_list,     change_predictors, change_predictors, change_own_bytes,
                                   change_own_bytes,  change_own_floats, change_view,       change_accessor,
                                   change_attributes, change_vertices,   change_vertices,   change_node,
                                   cut_binary};
    Random random(seed);
    for (std::size_t n = 1 + (random() % 4 == 0) + (random() % 16 == 0); n > 0; --n)
        try {
            kChanges[below(std::size(kChanges), random)](file, random);
        } catch (const Json::exception&) { // an earlier change removed the member
        }
    return file;
}

} // namespace prt::test

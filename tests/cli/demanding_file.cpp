// Builds a file with uncommon but valid glTF features.

#include "demanding_file.h"

namespace prt::test {

GlbFile demanding_file() {
    GlbFile file = triangle_file();
    const auto position =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1}, kFloat, "VEC3", 3);
    file.json["accessors"][position]["min"] = {0, 0, 0};
    file.json["accessors"][position]["max"] = {1, 1, 1};
    const auto uv =
        file.accessor(std::vector<std::uint8_t>{0, 0, 9, 9, 255, 0, 9, 9, 0, 255, 9, 9, 255, 255, 9, 9},
                      kUnsignedByte, "VEC2", 4, true, 4);
    file.json["accessors"][uv]["count"] = 4;
    file.json["images"] = {{{"uri", "a%20picture.png"}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    file.json["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}, {"mode", 5}, {"material", 0}});
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {3, 0, 0}}, {"scale", {1, -1, 1}}}};
    file.json["scenes"][0]["nodes"] = {0, 1};
    return file;
}

} // namespace prt::test

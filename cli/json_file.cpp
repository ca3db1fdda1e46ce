#include "json_file.h"

#include "prt/support/error.h"
#include "prt/support/file.h"

#include <fmt/core.h>

namespace prt::cli {

Json read_json(const std::filesystem::path& path) {
    const std::vector<std::byte> file = read_file(path);
    const char* begin = reinterpret_cast<const char*>(file.data());
    try { // the words of the library name its inner parts
        return Json::parse(begin, begin + file.size());
    } catch (const Json::parse_error& error) {
        throw Error(fmt::format("is no JSON from byte {} on", error.byte));
    } catch (const Json::exception&) {
        throw Error("holds a number beyond those of doubles");
    }
}

} // namespace prt::cli

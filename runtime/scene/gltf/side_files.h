#pragma once

#include "prt/gltf.h"

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace prt {

/// The files that the URIs of a scene name, as tinygltf asks for them. A scene may come from a stranger: it
/// reaches regular files in its folder and below, after ".." and links are followed, and no others unless it
/// is allowed to. A name that no file has stands for the one file that differs by backslashes, case, escapes
/// or a query.
class SideFiles {
public:
    /// Those of a scene of `scene_bytes` at `scene`.
    SideFiles(const std::filesystem::path& scene, std::size_t scene_bytes, const GltfOptions& options);

    /// They refer to this object. Names reach them as URIs say, without a folder.
    tinygltf::FsCallbacks callbacks();
    /// Why the file that `uri` names could not be read.
    std::string trouble_of(const std::string& uri) const;
    /// Files that were read in the place of those named, a line each.
    const std::set<std::string>& notices() const { return notices_; }
    /// Throws `Error` where one of them is an output.
    void check_outputs() const;

private:
    std::filesystem::path place_of(const std::string& name);
    std::vector<unsigned char> read(const std::string& name);
    std::filesystem::path folder_;
    const GltfOptions& options_;
    std::set<std::filesystem::path> seen_;
    std::uint64_t bytes_there_, bytes_read_ = 0;  ///< of the scene and of all files once; as often as named
    std::map<std::string, std::string> troubles_; ///< by name, without escapes
    std::set<std::string> notices_;
    int searches_ = 0; ///< for files that are not there
};

} // namespace prt

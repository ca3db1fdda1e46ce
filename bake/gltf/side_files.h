#pragma once

// External files of a scene.

#include "prt/gltf/gltf.h"

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace prt {

/// Reads the files that the URIs of a scene name, for tinygltf. A scene may come from an untrusted source: it
/// can access only regular files in its folder and subfolders, after resolving ".." and links, unless
/// GltfOptions::allow_outside is set. A name without a file is matched to the only file that differs in
/// backslashes, case, escapes or a query.
class SideFiles {
public:
    /// `scene`: path of the scene, of `scene_bytes`.
    SideFiles(const std::filesystem::path& scene, std::size_t scene_bytes, const GltfOptions& options);

    /// Returns callbacks that reference this object. They receive names as in the URIs, without a folder.
    tinygltf::FsCallbacks callbacks();
    /// Returns why the file that `uri` names could not be read.
    std::string trouble_of(const std::string& uri) const;
    /// Returns the files that were read instead of the named ones, one line each.
    const std::set<std::string>& notices() const { return notices_; }
    /// Throws `Error` if one of the files is an output.
    void check_outputs() const;

private:
    std::filesystem::path position_of(const std::string& name);
    std::vector<unsigned char> read(const std::string& name);
    std::filesystem::path folder_;
    const GltfOptions& options_;
    std::set<std::filesystem::path> seen_;
    std::uint64_t bytes_there_, bytes_read_ = 0;  ///< total size of the scene and of all files once; bytes
                                                  ///< read, including repeated names
    std::map<std::string, std::string> troubles_; ///< by name, without escapes
    std::set<std::string> notices_;
    int searches_ = 0; ///< number of searches for missing files
};

} // namespace prt

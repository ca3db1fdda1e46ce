// Finds and checks sets of receivers in a file.
#include "runtime/load/receiver_sets.h"

#include "prt/core/error.h"
#include "runtime/load/extensions.h"

#include <algorithm>
#include <map>
#include <string>

namespace prt {
namespace {

constexpr ReceiverKind kKinds[] = {ReceiverKind::vertices, ReceiverKind::texels, ReceiverKind::probes};
constexpr const char* kWriteAgain = "; write the file again with this version of prt";

/// Returns the member `name` of `set`, a string; empty if it is missing.
std::string word_of(const Json& set, const char* name) {
    const auto found = set.find(name);
    return found != set.end() && found->is_string() ? found->get<std::string>() : std::string();
}

void check_set(const Json& set) {
    if (!set.is_object())
        throw Error(std::string("a set of ") + kTransferExtension + " is not an object");
    const std::string kind = word_of(set, "receivers"), coding = word_of(set, "coding");
    if (std::ranges::none_of(kKinds, [&](ReceiverKind k) { return kind == to_string(k); }))
        throw Error("a set of receivers has neither vertices, texels nor probes");
    if (coding != to_string(Coding::raw) && coding != to_string(Coding::clustered))
        throw Error("the transfer of its " + kind + " is neither raw nor clustered");
    if (kind == to_string(ReceiverKind::vertices))
        return;
    for (const char* name : {"predictors", "centers"})
        if (set.contains(name))
            throw Error("the " + kind + " have " + name + ", which only vertices support");
    if (coding == to_string(Coding::clustered) && !set.contains("packing"))
        throw Error("the weights of its " + kind + " are not packed");
}

[[noreturn]] void throw_former(const char* extension) {
    throw Error(std::string("has ") + extension + ", a format of a former version" + kWriteAgain);
}

/// Returns the version of the transfer in the file; null if it has no transfer.
Json version_of(const GltfData& data) {
    const Json* extension = extension_of(data.json, kTransferExtension);
    return extension ? extension->value("version", Json(0)) : Json();
}

/// Throws `Error` if the file has transfer of another version.
void check_version(const GltfData& data) {
    for (const char* name : kFormerExtensions)
        if (extension_of(data.json, name))
            throw_former(name);
    if (const Json version = version_of(data); !version.is_null() && version != kTransferVersion)
        throw Error(std::string(kTransferExtension) + " has version " + version.dump() +
                    ", but this program reads version " + std::to_string(kTransferVersion) + kWriteAgain);
}

/// Returns the set of these receivers in a file of the current version.
const Json* set_of(const GltfData& data, ReceiverKind kind) {
    const Json* extension = extension_of(data.json, kTransferExtension);
    if (!extension)
        return nullptr;
    const Json& sets = extension->at("sets");
    if (!sets.is_array() || sets.empty())
        throw Error(std::string("the sets of ") + kTransferExtension +
                    " are not a list, or the list is empty");
    std::map<std::string, const Json*> found;
    for (const Json& set : sets) {
        check_set(set);
        if (!found.try_emplace(word_of(set, "receivers"), &set).second)
            throw Error("has two sets of " + word_of(set, "receivers"));
    }
    const auto one = found.find(to_string(kind));
    return one != found.end() ? one->second : nullptr;
}

bool has_coding(const Json* set, Coding coding) {
    return set && set->at("coding") == to_string(coding);
}

} // namespace

const char* to_string(ReceiverKind kind) {
    switch (kind) {
    case ReceiverKind::vertices:
        return "vertices";
    case ReceiverKind::texels:
        return "texels";
    case ReceiverKind::probes:
        break;
    }
    return "probes";
}

const char* to_string(Coding coding) {
    return coding == Coding::raw ? "raw" : "clustered";
}

const Json* find_set(const GltfData& data, ReceiverKind kind) {
    check_version(data);
    return set_of(data, kind);
}

const Json* find_set(const GltfData& data, ReceiverKind kind, Coding coding) {
    const Json* set = find_set(data, kind);
    return has_coding(set, coding) ? set : nullptr;
}

bool has_surface_transfer(const GltfData& data) {
    return find_set(data, ReceiverKind::vertices) || find_set(data, ReceiverKind::texels);
}

Json* find_set_to_decode(GltfData& data) {
    if (extension_of(data.json, kFormerClusteredExtension)) // its words and colors are needed as geometry is
        throw_former(kFormerClusteredExtension);
    if (version_of(data) != kTransferVersion)
        return nullptr;
    const Json* set = set_of(data, ReceiverKind::vertices);
    return has_coding(set, Coding::clustered) ? const_cast<Json*>(set) : nullptr;
}

} // namespace prt

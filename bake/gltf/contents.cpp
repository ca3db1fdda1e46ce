// Edits a glTF document: adds data, and removes data together with everything that only it used.
#include "bake/gltf/contents.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"
#include "runtime/load/own_attributes.h"
#include "runtime/load/receiver_sets.h"

#include <algorithm>
#include <functional>
#include <new>
#include <stdexcept>

namespace prt {
namespace {

void pad_to(std::vector<unsigned char>& bytes, std::size_t alignment) {
    bytes.resize((bytes.size() + alignment - 1) / alignment * alignment);
}

/// Calls `visit` with every object outside `extras`.
void for_each_object(Json& json, const std::function<void(Json&)>& visit) {
    if (json.is_object())
        visit(json);
    if (json.is_structured())
        for (auto it = json.begin(); it != json.end(); ++it)
            if (!json.is_object() || it.key() != "extras")
                for_each_object(*it, visit);
}

/// Removes elements of the array `name`; returns the new index of each remaining one.
std::vector<std::size_t> remove_elements(Json& json, const char* name, const std::set<std::size_t>& removed) {
    Json kept = Json::array();
    std::vector<std::size_t> new_index;
    for (std::size_t i = 0; i < json[name].size(); ++i) {
        new_index.push_back(kept.size());
        if (!removed.contains(i))
            kept.push_back(std::move(json[name][i]));
    }
    if (kept.empty())
        json.erase(name);
    else
        json[name] = std::move(kept);
    return new_index;
}

void renumber(Json& value, const std::vector<std::size_t>& new_index) {
    if (value.is_number_unsigned() && value.get<std::size_t>() < new_index.size())
        value = new_index[value.get<std::size_t>()];
}

/// Calls `visit` with every member of core glTF that references an accessor by index.
void for_each_accessor_reference(Json& json, const std::function<void(Json&)>& visit) {
    const auto all_of = [&](Json& attributes) {
        for (Json& accessor : attributes)
            visit(accessor);
    };
    for_each_primitive(json, [&](Json& primitive) {
        all_of(primitive["attributes"]);
        if (primitive.contains("indices"))
            visit(primitive["indices"]);
        if (primitive.contains("targets"))
            for (Json& target : primitive["targets"])
                all_of(target);
    });
    if (json.contains("skins"))
        for (Json& skin : json["skins"])
            if (skin.contains("inverseBindMatrices"))
                visit(skin["inverseBindMatrices"]);
    if (json.contains("animations"))
        for (Json& animation : json["animations"])
            if (animation.contains("samplers"))
                for (Json& sampler : animation["samplers"])
                    for (const char* key : {"input", "output"})
                        visit(sampler[key]);
    if (json.contains("nodes"))
        for (Json& node : json["nodes"])
            if (node.contains("extensions") && node["extensions"].contains("EXT_mesh_gpu_instancing"))
                all_of(node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]);
}

struct ByteRange {
    std::size_t begin, end;
};

ByteRange range_of(const Json& view) {
    const std::size_t begin = view.value("byteOffset", std::size_t{0});
    return {begin, begin + view.value("byteLength", std::size_t{0})};
}

/// Ranges of the buffer that are kept, sorted and disjoint, and their new positions.
class KeptRanges {
public:
    void add(ByteRange range) { ranges_.push_back(range); }
    /// Extends ranges to multiples of 8 bytes, so that every kept view keeps its alignment.
    void finish(std::size_t size) {
        for (ByteRange& range : ranges_)
            range = {range.begin / 8 * 8, std::min((range.end + 7) / 8 * 8, size)};
        std::sort(ranges_.begin(), ranges_.end(), [](ByteRange a, ByteRange b) { return a.begin < b.begin; });
        std::vector<ByteRange> merged;
        for (const ByteRange& range : ranges_) {
            if (!merged.empty() && range.begin <= merged.back().end)
                merged.back().end = std::max(merged.back().end, range.end);
            else if (range.begin < range.end)
                merged.push_back(range);
        }
        ranges_ = std::move(merged);
        std::size_t to = 0;
        for (const ByteRange& range : ranges_) {
            positions_.push_back(to);
            to += range.end - range.begin;
        }
    }
    /// Returns the new position of a kept byte; the result is arbitrary for others.
    std::size_t position(std::size_t offset) const {
        const auto after =
            std::upper_bound(ranges_.begin(), ranges_.end(), offset,
                             [](std::size_t o, const ByteRange& range) { return o < range.begin; });
        if (after == ranges_.begin())
            return 0;
        const auto at = static_cast<std::size_t>(after - ranges_.begin()) - 1;
        return positions_[at] + std::min(offset, ranges_[at].end) - ranges_[at].begin;
    }
    void move_bytes(std::vector<unsigned char>& bytes) const {
        std::size_t size = 0;
        for (std::size_t r = 0; r < ranges_.size(); ++r) { // always towards the front
            std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(ranges_[r].begin),
                      bytes.begin() + static_cast<std::ptrdiff_t>(ranges_[r].end),
                      bytes.begin() + static_cast<std::ptrdiff_t>(positions_[r]));
            size = positions_[r] + ranges_[r].end - ranges_[r].begin;
        }
        bytes.resize(size);
        bytes.shrink_to_fit();
    }

private:
    std::vector<ByteRange> ranges_;
    std::vector<std::size_t> positions_;
};

/// Removes bytes from the buffer that no view, or only removed views, reference.
void cut_bytes(GltfContents& contents, const std::set<std::size_t>& removed) {
    KeptRanges kept;
    Json& views = contents.json["bufferViews"];
    for (std::size_t i = 0; i < views.size(); ++i)
        if (!removed.contains(i))
            kept.add(range_of(views[i]));
    kept.finish(contents.binary().size());
    for (Json& view : views)
        view["byteOffset"] = kept.position(range_of(view).begin);
    for (GltfBufferView& view : contents.model.bufferViews)
        view.byteOffset = kept.position(view.byteOffset);
    kept.move_bytes(contents.binary());
}

void erase_accessors(GltfContents& contents, const std::set<std::size_t>& accessors) {
    Json& json = contents.json;
    if (accessors.empty() || !json.contains("accessors"))
        return;
    const auto new_index = remove_elements(json, "accessors", accessors);
    for_each_accessor_reference(json, [&](Json& accessor) { renumber(accessor, new_index); });
}

void erase_views(GltfContents& contents, const std::set<std::size_t>& views) {
    Json& json = contents.json;
    if (views.empty() || !json.contains("bufferViews"))
        return;
    cut_bytes(contents, views);
    const auto new_index = remove_elements(json, "bufferViews", views);
    for_each_object(json, [&](Json& object) {
        if (object.contains("bufferView"))
            renumber(object["bufferView"], new_index);
    });
}

/// Removes the extension `name` of `owner`, if it has one; calls `take` with its value first.
template <class Take>
void take_extension(Json& owner, const char* name, Take&& take) {
    if (!extension_of(owner, name))
        return;
    take(owner["extensions"][name]);
    erase_extension(owner, name);
}

/// Removes the sets of probes, or all others; calls `take` with each first. Transfer of a former version
/// counts as transfer of surfaces.
template <class Take>
void take_sets(Json& json, bool of_probes, Take&& take) {
    const auto keep_others = [&](Json& sets) {
        Json kept = Json::array();
        for (Json& set : sets) {
            const bool probes =
                set.is_object() && set.value("receivers", Json()) == to_string(ReceiverKind::probes);
            if (probes != of_probes)
                kept.push_back(std::move(set));
            else
                take(set);
        }
        sets = std::move(kept);
        return !sets.empty();
    };
    if (!extension_of(json, kTransferExtension))
        return;
    Json& extension = json["extensions"][kTransferExtension];
    const bool has_sets = extension.contains("sets") && extension["sets"].is_array();
    if (has_sets ? keep_others(extension["sets"]) : of_probes)
        return;
    take(extension);
    erase_extension(json, kTransferExtension);
}

/// Calls `visit` with every member that names the image of a texture.
template <class Visit>
void for_each_source(Json& json, Visit&& visit) {
    if (json.contains("textures"))
        for_each_object(json["textures"], [&](Json& object) {
            if (object.contains("source") && object["source"].is_number_unsigned())
                visit(object["source"]);
        });
}

/// Returns a visitor of objects that adds the buffer views which they name to `views`.
auto collect_views(std::set<std::size_t>& views) {
    return [&views](const Json& object) {
        if (object.contains("bufferView") && object["bufferView"].is_number_unsigned())
            views.insert(object["bufferView"].get<std::size_t>());
    };
}

/// Adds the images of lightmap words in `set` to `images`.
void collect_images(const Json& set, std::set<std::size_t>& images) {
    if (!set.is_object() || !set.contains("maps"))
        return;
    for (const Json& map : set["maps"])
        if (map.is_object() && map.contains("images"))
            for (const Json& image : map["images"])
                if (image.is_number_unsigned())
                    images.insert(image.get<std::size_t>());
}

} // namespace

/// Data of extensions that were removed, to free it if nothing else uses it.
struct GltfContents::Removed {
    std::set<std::size_t> views, accessors, images;

    void take(Json& data) {
        for_each_object(data, collect_views(views));
        collect_images(data, images);
    }
    void take_attributes(Json& primitive, bool (*takes)(std::string_view)) {
        Json kept = Json::object();
        for (auto it = primitive["attributes"].begin(); it != primitive["attributes"].end(); ++it) {
            if (takes(it.key()))
                accessors.insert(it->get<std::size_t>());
            else
                kept[it.key()] = *it;
        }
        primitive["attributes"] = std::move(kept);
    }
    /// Takes everything except lobes.
    void take_transfer(Json& primitive) {
        take_extension(primitive, kTransferExtension, [&](Json& data) { take(data); });
        for (const char* name : kFormerExtensions)
            take_extension(primitive, name, [&](Json& data) { take(data); });
        take_attributes(primitive, [](std::string_view name) {
            return is_own_attribute(name) && !is_lobe_attribute(name);
        });
    }
};

namespace {

/// Removes unused elements of `images`; adds their views to `views`.
void remove_images(GltfContents& contents, std::set<std::size_t> images, std::set<std::size_t>& views) {
    Json& json = contents.json;
    for_each_source(json, [&](const Json& source) { images.erase(source.get<std::size_t>()); });
    if (images.empty() || !json.contains("images"))
        return;
    for (const std::size_t i : images)
        if (i < json["images"].size() && json["images"][i].contains("bufferView"))
            views.insert(json["images"][i]["bufferView"].get<std::size_t>());
    const auto new_index = remove_elements(json, "images", images);
    for_each_source(json, [&](Json& source) { renumber(source, new_index); });
    const auto erase_from = [&](auto& list) {
        for (auto i = images.rbegin(); i != images.rend(); ++i)
            if (*i < list.size())
                list.erase(list.begin() + static_cast<std::ptrdiff_t>(*i));
    };
    erase_from(contents.images);
    erase_from(contents.parsed.images);
}

} // namespace

std::size_t GltfContents::add_buffer_view(std::span<const std::byte> bytes, std::size_t stride,
                                          bool vertices) {
    static constexpr std::byte kNothing[4] = {}; // glTF does not allow empty views
    if (bytes.empty())
        bytes = kNothing;
    std::vector<unsigned char>& buffer = binary();
    pad_to(buffer, 8);
    Json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
    if (stride > 0)
        view["byteStride"] = stride;
    if (vertices)
        view["target"] = kArrayBuffer;
    // Grow by at least an eighth, so that many views are copied only a few times each, and one large view is
    // not doubled.
    if (const std::size_t needed = buffer.size() + bytes.size() + 8; needed > buffer.capacity())
        buffer.reserve(std::max(needed, buffer.size() + buffer.size() / 8));
    const auto* begin = reinterpret_cast<const unsigned char*>(bytes.data());
    buffer.insert(buffer.end(), begin, begin + bytes.size());
    pad_to(buffer, 8);
    Json& views = member(json, "bufferViews", Json::value_t::array);
    model.bufferViews.push_back({0, view["byteOffset"].get<std::size_t>(), bytes.size(), stride});
    views.push_back(std::move(view));
    return views.size() - 1;
}

std::size_t GltfContents::add_accessor(Json accessor) {
    Json& accessors = member(json, "accessors", Json::value_t::array);
    model.accessors.push_back(read_accessor(accessor));
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
}

void GltfContents::use_extension(const std::string& name) {
    Json& used = member(json, "extensionsUsed", Json::value_t::array);
    if (std::find(used.begin(), used.end(), name) == used.end())
        used.push_back(name);
}

void GltfContents::cut_unused_bytes() {
    if (json.contains("bufferViews"))
        cut_bytes(*this, {});
}

void GltfContents::drop_unused_extensions() {
    bool used = extension_of(json, kTransferExtension) != nullptr;
    for_each_primitive(
        json, [&](const Json& primitive) { used = used || extension_of(primitive, kTransferExtension); });
    if (!used)
        drop_extension(json, kTransferExtension);
}

void GltfContents::remove_volume() {
    bool found = false;
    std::set<std::size_t> views;
    take_sets(json, true, [&](Json& set) {
        found = true;
        for_each_object(set, collect_views(views));
    });
    if (!found)
        return;
    remove_unused({}, std::move(views));
    drop_unused_extensions();
}

void GltfContents::remove_transfer() {
    Removed removed;
    const auto take = [&](Json& data) { removed.take(data); };
    take_sets(json, false, take);
    for (const char* name : kFormerExtensions)
        take_extension(json, name, take);
    const bool lobes = extension_of(json, kLobeExtension);
    for_each_primitive(json, [&](Json& primitive) {
        removed.take_transfer(primitive);
        if (!lobes) // left by a program that does not copy the extension
            removed.take_attributes(primitive, is_lobe_attribute);
    });
    if (separate.empty()) { // otherwise the written data belongs to it
        take_extension(json, kInstancesExtension, take);
        if (json.contains("nodes"))
            for (Json& node : json["nodes"])
                take_extension(node, kInstancesExtension, take);
        drop_extension(json, kInstancesExtension);
    }
    finish(std::move(removed));
    for (const char* name : kFormerExtensions)
        drop_extension(json, name);
}

void GltfContents::remove_transfer_of(std::span<Json* const> primitives) {
    Removed removed;
    for (Json* primitive : primitives)
        removed.take_transfer(*primitive);
    finish(std::move(removed));
}

void GltfContents::remove_lobes() {
    Removed removed;
    take_extension(json, kLobeExtension, [&](Json& data) { removed.take(data); });
    for_each_primitive(json, [&](Json& primitive) { removed.take_attributes(primitive, is_lobe_attribute); });
    finish(std::move(removed));
    drop_extension(json, kLobeExtension);
}

void GltfContents::finish(Removed removed) {
    remove_images(*this, std::move(removed.images), removed.views);
    remove_unused(std::move(removed.accessors), std::move(removed.views));
    drop_unused_extensions();
}

void GltfContents::remove_unused(std::set<std::size_t> accessors, std::set<std::size_t> views) {
    for_each_accessor_reference(json, [&](Json& accessor) {
        if (accessor.is_number_unsigned())
            accessors.erase(accessor.get<std::size_t>());
    });
    const auto for_each_view = [](Json& below, const auto& visit) {
        for_each_object(below, [&](Json& object) {
            if (object.contains("bufferView") && object["bufferView"].is_number_unsigned())
                visit(object["bufferView"].get<std::size_t>());
        });
    };
    for (const std::size_t a : accessors)
        if (json.contains("accessors") && a < json["accessors"].size())
            for_each_view(json["accessors"][a], [&](std::size_t view) { views.insert(view); });
    erase_accessors(*this, accessors);
    for_each_view(json, [&](std::size_t view) { views.erase(view); });
    erase_views(*this, views);
    std::vector<GltfBuffer> buffers = std::move(model.buffers);
    model = read_model(json);
    model.buffers = std::move(buffers);
}

} // namespace prt

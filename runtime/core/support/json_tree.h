#pragma once

// Parses JSON into trees of nlohmann-json that keep the order of keys. The time is n log n for an object of n
// keys; the parser of nlohmann-json takes n², because it compares each key with all keys before it. Not part
// of the interface.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace prt {

/// Receives the events of `Json::sax_parse` and builds the tree of the text. `Json` is
/// nlohmann::ordered_json. A key that an object repeats is stored once, at its first position with its last
/// value, as `Json::parse` stores it.
template <class Json>
class JsonTreeBuilder {
public:
    /// Moves the tree to the caller. Must be called once, after `Json::sax_parse` has returned.
    Json take() { return std::move(root_); }

    // The interface of nlohmann-json's `json_sax`. Each event adds to the tree; true: the parser continues.
    bool null() { return add(Json(nullptr)); }
    bool boolean(bool value) { return add(Json(value)); }
    bool number_integer(typename Json::number_integer_t value) { return add(Json(value)); }
    bool number_unsigned(typename Json::number_unsigned_t value) { return add(Json(value)); }
    bool number_float(typename Json::number_float_t value, const std::string&) { return add(Json(value)); }
    bool string(std::string& value) { return add(Json(std::move(value))); }
    bool binary(typename Json::binary_t&) { return false; } // not in text
    bool start_object(std::size_t) { return open(Json::object()); }
    bool start_array(std::size_t) { return open(Json::array()); }
    bool key(std::string& name) {
        open_.back().key = std::move(name);
        return true;
    }
    bool end_object() {
        merge_equal_keys(*open_.back().value.template get_ptr<typename Json::object_t*>());
        return close();
    }
    bool end_array() { return close(); }
    template <class Exception>
    bool parse_error(std::size_t, const std::string&, const Exception& error) {
        throw error;
    }

private:
    using Object = typename Json::object_t;
    /// An object or array that the parser has not ended yet.
    struct Level {
        Json value;           ///< the object or array, with the members or elements so far
        std::string key = {}; ///< key of the next member of an object
    };

    bool add(Json&& value) {
        if (open_.empty())
            root_ = std::move(value);
        else if (auto* object = open_.back().value.template get_ptr<Object*>())
            object->emplace_back(std::move(open_.back().key), std::move(value));
        else
            open_.back().value.push_back(std::move(value));
        return true;
    }

    bool open(Json&& value) {
        open_.push_back({std::move(value)});
        return true;
    }

    bool close() {
        Json value = std::move(open_.back().value);
        open_.pop_back();
        return add(std::move(value));
    }

    static void merge_equal_keys(Object& object) {
        std::vector<std::size_t> order(object.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        const auto item = [&](std::size_t i) -> auto& {
            return object.begin()[static_cast<std::ptrdiff_t>(i)];
        };
        const auto key = [&](std::size_t i) -> const std::string& { return item(i).first; };
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            const int compared = key(a).compare(key(b));
            return compared < 0 || (compared == 0 && a < b);
        });
        std::vector<bool> dropped;
        for (std::size_t i = 0; i < order.size();) {
            std::size_t last = i;
            while (last + 1 < order.size() && key(order[last + 1]) == key(order[i]))
                ++last;
            if (last > i) {
                dropped.resize(object.size(), false);
                item(order[i]).second = std::move(item(order[last]).second);
                for (std::size_t other = i + 1; other <= last; ++other)
                    dropped[order[other]] = true;
            }
            i = last + 1;
        }
        if (dropped.empty())
            return;
        Object kept; // its keys are constant: they cannot be moved down
        for (std::size_t i = 0; i < object.size(); ++i)
            if (!dropped[i])
                kept.emplace_back(key(i), std::move(item(i).second));
        object.swap(kept);
    }

    Json root_;               ///< the tree; set when its outermost value ends
    std::vector<Level> open_; ///< from the outermost object or array to the innermost
};

/// Returns the tree of the JSON document `text`. Throws what `Json::parse` throws: `Json::parse_error` for
/// invalid JSON, `Json::out_of_range` for a number that does not fit into a double.
template <class Json>
Json parse_json_tree(std::string_view text) {
    JsonTreeBuilder<Json> builder;
    Json::sax_parse(text.begin(), text.end(), &builder);
    return builder.take();
}

} // namespace prt

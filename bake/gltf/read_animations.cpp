// Reads animations of nodes (glTF 2.0, section 3.11).
#include "bake/gltf/read_animations.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace prt {
namespace {

std::optional<AnimatedPart> animated_part(const std::string& path) {
    if (path == "translation")
        return AnimatedPart::translation;
    if (path == "rotation")
        return AnimatedPart::rotation;
    if (path == "scale")
        return AnimatedPart::scale;
    return {}; // weights of morph targets, or targets of extensions
}

Interpolation interpolation_of(const std::string& name) {
    if (name == "STEP")
        return Interpolation::step;
    if (name == "LINEAR" || name.empty())
        return Interpolation::linear;
    if (name == "CUBICSPLINE")
        return Interpolation::cubic_spline;
    throw Error("its interpolation '" + name + "' is not LINEAR, STEP or CUBICSPLINE");
}

std::vector<float> read_times(const GltfModel& model, int accessor) {
    std::vector<float> times = read_floats(model, accessor, 1);
    if (times.empty())
        throw Error("it has no keyframes");
    for (std::size_t i = 0; i < times.size(); ++i)
        if (!std::isfinite(times[i]))
            throw Error("the time of keyframe " + std::to_string(i) + " is not finite");
    if (const auto falls = std::is_sorted_until(times.begin(), times.end()); falls != times.end())
        throw Error("keyframe " + std::to_string(falls - times.begin()) +
                    " is earlier than the previous one");
    return times;
}

std::vector<glm::vec4> read_values(const GltfModel& model, int accessor, const AnimationChannel& channel) {
    const std::size_t components = channel.part == AnimatedPart::rotation ? 4 : 3,
                      of_key = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
    const std::vector<float> numbers = read_floats(model, accessor, static_cast<int>(components));
    const std::size_t count = numbers.size() / components;
    if (count != of_key * channel.times.size())
        throw Error("it has " + counted(count, "value") + ", but its " +
                    counted(channel.times.size(), "keyframe needs ", "keyframes need ") +
                    std::to_string(of_key * channel.times.size()));
    std::vector<glm::vec4> values(count, glm::vec4(0));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (!std::isfinite(numbers[i]))
            throw Error("value " + std::to_string(i / components) + " is not finite");
        values[i / components][static_cast<int>(i % components)] = numbers[i];
    }
    for (std::size_t key = 0; channel.part == AnimatedPart::rotation && key < channel.times.size(); ++key)
        if (values[of_key * key + of_key / 2] == glm::vec4(0))
            throw Error("the rotation of keyframe " + std::to_string(key) +
                        " is not a rotation: all components are 0");
    return values;
}

/// Reads a channel; empty if it does not move a node.
std::optional<AnimationChannel> read_channel(const GltfModel& model, const tinygltf::Animation& animation,
                                             const tinygltf::AnimationChannel& file) {
    const std::optional<AnimatedPart> part = animated_part(file.target_path);
    if (!part || file.target_node == -1)
        return {};
    const auto node = static_cast<std::size_t>(file.target_node),
               sampler_at = static_cast<std::size_t>(file.sampler);
    if (file.target_node < 0 || node >= model.nodes.size())
        throw Error("it moves node " + std::to_string(file.target_node) + ", which does not exist");
    if (!model.nodes[node].matrix.empty())
        throw Error("it moves node " + std::to_string(node) +
                    ", which has a matrix; only translation, rotation and scale can be animated");
    if (file.sampler < 0 || sampler_at >= animation.samplers.size())
        throw Error("its sampler " + std::to_string(file.sampler) + " does not exist");
    const tinygltf::AnimationSampler& sampler = animation.samplers[sampler_at];
    AnimationChannel channel{node, *part, interpolation_of(sampler.interpolation), {}, {}};
    channel.times = read_times(model, sampler.input);
    channel.values = read_values(model, sampler.output, channel);
    return channel;
}

double speed_of(const Json& animation) {
    const auto extras = animation.find("extras");
    if (extras == animation.end() || !extras->is_object() || !extras->contains("speed") ||
        !extras->at("speed").is_number())
        return 0;
    const double speed = extras->at("speed").get<double>();
    return speed >= 0 && speed <= 1e3 ? speed : 0; // supersonic speeds are treated as errors
}

/// Accessors claim keys that no data stands for, and channels read them as often as they name them.
void check_keys(const GltfContents& contents) {
    constexpr double kTime = 8, kValue = 40; // bytes while they are read
    double bytes = 0;
    for (const tinygltf::Animation& animation : contents.parsed.animations)
        for (const tinygltf::AnimationChannel& channel : animation.channels) {
            const auto sampler = static_cast<std::size_t>(channel.sampler);
            if (channel.sampler < 0 || sampler >= animation.samplers.size())
                continue; // refused where it is read
            for (const auto& [accessor, size] : {std::pair(animation.samplers[sampler].input, kTime),
                                                 std::pair(animation.samplers[sampler].output, kValue)})
                bytes += size * static_cast<double>(get_accessor(contents.model, accessor).count);
        }
    check_allowed(bytes, contents.file_bytes, "the keyframes of its animations, copied for each channel,");
}

} // namespace

std::vector<Animation> read_animations(const GltfContents& contents) {
    const GltfModel& model = contents.model;
    check_keys(contents);
    std::vector<Animation> animations;
    for (std::size_t a = 0; a < contents.parsed.animations.size(); ++a) {
        const tinygltf::Animation& file = contents.parsed.animations[a];
        Animation animation{file.name, 0, speed_of(contents.json["animations"][a]), {}};
        for (std::size_t c = 0; c < file.channels.size(); ++c) {
            try {
                if (std::optional<AnimationChannel> channel = read_channel(model, file, file.channels[c])) {
                    animation.duration = std::max<double>(animation.duration, channel->times.back());
                    animation.channels.push_back(std::move(*channel));
                }
            } catch (const Error& error) {
                throw Error("animation " + std::to_string(a) + " channel " + std::to_string(c) + ": " +
                            error.what());
            }
        }
        animations.push_back(std::move(animation));
    }
    return animations;
}

} // namespace prt

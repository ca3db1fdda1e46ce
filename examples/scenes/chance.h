#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <random>

namespace examples {

/// Random numbers that are the same in every run.
class Chance {
public:
    explicit Chance(unsigned seed) : random_(seed) {}

    /// Returns a unit vector, uniformly distributed over all directions.
    glm::vec3 direction() {
        return glm::normalize(glm::vec3(normal_(random_), normal_(random_), normal_(random_)));
    }
    float between(float low, float high) { return std::lerp(low, high, unit_(random_)); }

private:
    std::mt19937 random_;
    std::normal_distribution<float> normal_;
    std::uniform_real_distribution<float> unit_{0, 1};
};

} // namespace examples

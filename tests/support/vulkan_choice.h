#pragma once

#include "bake/device/vulkan_device.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace prt::test {

/// The traversal that this run is to test, with every call validated: our own, or where PRT_TEST_RAY_QUERIES
/// is set that of the device.
inline VulkanChoice vulkan_choice() {
    const bool queries = std::getenv("PRT_TEST_RAY_QUERIES") != nullptr;
    return {.traversal = queries ? Traversal::device : Traversal::compute, .validate = true};
}

/// Expects that the device was used without validation errors, with the chosen kind of traversal.
inline void expect_valid(const VulkanDevice& device) {
    EXPECT_EQ(device.traits().ray_queries, vulkan_choice().traversal == Traversal::device);
    for (const std::string& complaint : device.complaints())
        ADD_FAILURE() << complaint;
}

} // namespace prt::test

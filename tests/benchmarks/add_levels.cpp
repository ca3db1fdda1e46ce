// Adds coarser levels of detail to a .glb: add_levels IN.glb OUT.glb FRACTION ...
#include "support/level_file.h"

#include <cstdio>
#include <cstdlib>

int main(int count, char** arguments) {
    if (count < 4)
        return std::puts("add_levels IN.glb OUT.glb SHARE ..."), 2;
    std::vector<float> shares;
    for (int i = 3; i < count; ++i)
        shares.push_back(std::strtof(arguments[i], nullptr));
    prt::test::with_levels(prt::test::read_glb(arguments[1]), shares).write(arguments[2]);
    return 0;
}

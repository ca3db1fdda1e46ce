// The suns of a picture, and positions in their maps.

#include "shared_suns.h"

layout(std430, binding = PRT_BINDING_SUNS) readonly buffer Suns {
    SunsSeen suns_seen;
};

// Returns a position in texels, and in metres behind the near plane; `seen` is relative to the eye.
vec3 position_in_map(SunMap map, vec3 seen) {
    vec4 at = vec4(seen, 1.0);
    return vec3(dot(map.across, at), dot(map.up, at), dot(map.along, at));
}

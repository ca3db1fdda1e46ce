// Exit radiance for albedo 1 from a lightmap that prt_texels.comp computed.

#include "shared_layout.h"

layout(binding = PRT_UNIT_LIGHTMAP) uniform sampler2D lightmap;

in vec2 lightmap_texcoord;

vec3 given_radiance() {
    return texture(lightmap, lightmap_texcoord).rgb;
}

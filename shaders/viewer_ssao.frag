// Screen-space ambient occlusion: compares points around the pixel's position with the depth buffer (M.
// Mittring, "Finding Next Gen: CryEngine 2", SIGGRAPH 2007 course). With normals it uses only points above
// the surface, weighted by their cosine (D. Filion and R. McNaughton, "StarCraft II: Effects and Techniques",
// SIGGRAPH 2008 course).

#include "viewer_gbuffer.glsl"

uniform mat4 view_projection, inverse_view_projection;
uniform vec3 eye, forward;
uniform float radius;    // metres
uniform float bias;      // relative to the radius
uniform float intensity; // exponent
uniform int pairs;       // pairs of opposite points
uniform bool use_normals;

out float result;

vec3 position(vec2 uv, float depth) {
    vec4 p = inverse_view_projection * vec4(vec3(uv, depth) * 2.0 - 1.0, 1.0);
    return p.xyz / p.w;
}

// Point i of `pairs` in the ball, one of two opposite points: a spiral of equal areas, radii of equal
// volumes.
vec3 kernel(int i) {
    float share = (float(i) + 0.5) / float(pairs);
    float z = share, angle = 2.39996323 * float(i);
    float shell = fract(0.7548776662 * float(i) + 0.5);
    return vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z) * pow(shell, 1.0 / 3.0);
}

// Returns 1 if the point is hidden behind a near surface.
float hidden(vec3 point, float center_depth) {
    vec4 clip = view_projection * vec4(point, 1.0);
    vec2 uv = clip.xy / clip.w * 0.5 + 0.5;
    bool inside = clip.w > 0.0 && all(greaterThanEqual(uv, vec2(0.0))) && all(lessThan(uv, vec2(1.0)));
    ivec2 size = textureSize(gbuffer_depth, 0);
    vec2 at = inside ? uv : vec2(0.5);
    float depth = texelFetch(gbuffer_depth, ivec2(at * vec2(size)), 0).r;
    float surface = dot(position(at, depth) - eye, forward);
    float behind = dot(point - eye, forward) - surface;
    // Surfaces far in front hide nothing: they would cause halos.
    float near = smoothstep(0.0, 1.0, radius / max(abs(center_depth - surface), 1e-6 * radius));
    return inside && depth < 1.0 && behind > bias * radius ? near : 0.0;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 size = vec2(textureSize(gbuffer_depth, 0));
    float depth = texelFetch(gbuffer_depth, pixel, 0).r;
    if (depth == 1.0) {
        result = 1.0;
        return;
    }
    vec3 p = position((vec2(pixel) + 0.5) / size, depth);
    float center_depth = dot(p - eye, forward);
    vec3 n = gbuffer_normal_at(pixel);
    // Mirrors the kernel differently for each pixel of 4 x 4; the blur averages them.
    int tile = (pixel.x & 3) + 4 * (pixel.y & 3);
    float mirror_z = (float((tile * 7) & 15) + 0.5) / 8.0 - 1.0, mirror_angle = 2.39996323 * float(tile);
    vec3 mirror = vec3(sqrt(1.0 - mirror_z * mirror_z) * vec2(cos(mirror_angle), sin(mirror_angle)), mirror_z);
    float blocked = 0.0, all_weights = 0.0;
    for (int i = 0; i < pairs; ++i) {
        vec3 offset = reflect(kernel(i), mirror) * radius;
        if (use_normals) {
            float cosine = dot(normalize(offset), n);
            vec3 above = cosine >= 0.0 ? offset : -offset;
            blocked += abs(cosine) * hidden(p + above, center_depth);
            all_weights += abs(cosine);
        } else {
            blocked += 0.5 * (hidden(p + offset, center_depth) + hidden(p - offset, center_depth));
            all_weights += 1.0;
        }
    }
    float visible = 1.0 - blocked / all_weights;
    // Half of the ball is below a plane: an unoccluded plane has visibility 1.
    if (!use_normals)
        visible = min(1.0, 2.0 * visible);
    result = pow(clamp(visible, 0.0, 1.0), intensity);
}

// Converts a value to a few bits of a G-buffer, for example ambient occlusion to five bits. Ordered dithering
// (Bayer 1973) preserves its mean. For GLSL 330, ESSL 300 and later.

// Returns the dither threshold of a pixel, in (0, 1). Each of 64 thresholds occurs once in 8 x 8 pixels.
float prt_bayer_threshold(uvec2 pixel) {
    uint value = 0u;
    for (uint bit = 0u; bit < 3u; ++bit) {
        uint x = (pixel.x >> bit) & 1u, y = (pixel.y >> bit) & 1u;
        value |= (((x ^ y) << 1u) | y) << (4u - 2u * bit);
    }
    return (float(value) + 0.5) / 64.0;
}

// Returns the level, 0 to `levels` (31.0 for five bits), of a value in 0..1; divide it by `levels` to decode.
// `threshold`: prt_bayer_threshold(uvec2(gl_FragCoord.xy)), or 0.5 to round.
float prt_dithered_level(float value, float levels, float threshold) {
    return clamp(floor(value * levels + threshold), 0.0, levels);
}

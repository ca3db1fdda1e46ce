// Interpolated vertex color, multiplied by a tint.

in vec4 surface_color;
uniform vec4 tint;
out vec4 result;

void main() {
    result = surface_color * tint;
}

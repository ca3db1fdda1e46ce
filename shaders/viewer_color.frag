// As it is. Alpha 0: nothing that pictures are compared by.

in vec4 surface_color;
out vec4 result;

void main() {
    result = surface_color;
}

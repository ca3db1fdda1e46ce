// One triangle that covers the picture, behind everything.

out vec2 position;

void main() {
    position = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(position, 1.0, 1.0);
}

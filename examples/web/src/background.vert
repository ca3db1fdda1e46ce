varying vec3 direction;

void main() {
  direction = position;
  gl_Position = projectionMatrix * mat4(mat3(viewMatrix)) * vec4(position, 1.0);
  gl_Position.z = gl_Position.w; // behind everything
}

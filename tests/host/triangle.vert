// One large triangle, turned by the instance: no vertex buffer.
#version 450
void main() {
  const float angle = 2.0943951 * float(gl_VertexIndex) + 0.1 * float(gl_InstanceIndex);
  gl_Position = vec4(0.9 * cos(angle), 0.9 * sin(angle), 0.5, 1.0);
}

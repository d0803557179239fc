// Rays from inside begin in one leaf: a triangle over the picture. From outside, the faces of the
// hull that look to the eye are drawn, each with the tet behind it.
precision highp float;
precision highp int;

uniform bool inside;
uniform int start;
uniform vec3 eye, forward, right, up;
in vec3 corner;
in float zone;
flat out int entry;

void main() {
    if (inside) {
        entry = start;
        gl_Position = vec4(vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1), 0.0, 1.0);
        return;
    }
    entry = int(zone);
    vec3 p = corner - eye;
    gl_Position = vec4(dot(p, right) / dot(right, right), dot(p, up) / dot(up, up), 0.0,
                       dot(p, forward));
}

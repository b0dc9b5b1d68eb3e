// Parameters in vectors, results in arguments, and what only shading wants.
#ifdef GL_ES
precision mediump float;
#endif
#define LIFT vec3(0, 0.2, 0)
#define UNION(a, b) min(a, b)
float glow = 0.0;
vec3 tint = vec3(0.2, 0.3, 0.4);

float sdCapsule(vec3 p, vec3 a, vec3 b, float r) {
    vec3 pa = p - a, ba = b - a;
    float h = clamp(dot(pa, ba)/dot(ba, ba), 0.0, 1.0);
    return length(pa - ba*h) - r;
}
void closest(in vec3 p, out float d, out vec3 colour) {
    vec4 s = vec4(0, 1, 0.5, 0.4);
    d = length(p - s.xyz) - s.w;
    colour = tint*2.0;
    if (d < 0.1) { colour = vec3(1); glow += 0.1/(1.0 + d*d); }
}
float GetDist(vec3 p) {
    float d; vec3 c;
    closest(p - LIFT, d, c);
    float capsule = sdCapsule(p, vec3(-1.0, 0.4, 0.1), vec3(1.2, 0.5, -0.3), 0.2);
    return UNION(UNION(d, capsule), p.y);
}

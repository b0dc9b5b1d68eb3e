// Domains that are folded: arguments that functions change.
#define PI 3.14159265
#define TAU (2.0*PI)

float vmax(vec3 v) { return max(max(v.x, v.y), v.z); }
float fBox(vec3 p, vec3 b) {
    vec3 d = abs(p) - b;
    return length(max(d, vec3(0))) + vmax(min(d, vec3(0)));
}
void pR(inout vec2 p, float a) { p = cos(a)*p + sin(a)*vec2(p.y, -p.x); }
float pMod1(inout float p, float size) {
    float halfsize = size*0.5;
    float c = floor((p + halfsize)/size);
    p = mod(p + halfsize, size) - halfsize;
    return c;
}
float pModPolar(inout vec2 p, float repetitions) {
    float angle = 2.0*PI/repetitions;
    float a = atan(p.y, p.x) + angle/2.;
    float r = length(p);
    float c = floor(a/angle);
    a = mod(a,angle) - angle/2.;
    p = vec2(cos(a), sin(a))*r;
    if (abs(c) >= (repetitions/2.)) c = abs(c);
    return c;
}
float fOpUnionRound(float a, float b, float r) {
    vec2 u = max(vec2(r - a,r - b), vec2(0));
    return max(r, min (a, b)) - length(u);
}
float map(vec3 p) {
    vec3 q = p;
    pModPolar(q.xz, 7.0);
    q.x -= 1.2;
    pR(q.xy, PI/5.0);
    float ring = fBox(q, vec3(0.2, 0.35, 0.15));
    vec3 c = p;
    float cell = pMod1(c.y, 0.8);
    float column = max(length(c) - 0.3 - 0.02*cell, abs(p.y) - 2.0);
    return fOpUnionRound(ring, column, 0.1);
}

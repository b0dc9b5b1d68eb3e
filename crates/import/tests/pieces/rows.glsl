// Loops over things in rows, choices, arrays.
const vec3 places[3] = vec3[3](vec3(-1.0, 0.0, 0.2), vec3(0.1, 0.3, -0.5), vec3(0.9, -0.2, 0.4));
const float radii[3] = float[3](0.3, 0.45, 0.25);
uniform float uGrow;

float sdf(vec3 p) {
    float d = 1e10;
    for (int i = 0; i < 3; i++)
        d = min(d, length(p - places[i]) - radii[i]);
    for (float a = 0.0; a < 4.0; a += 1.0) {
        vec3 q = p - vec3(0.6*(a - 1.5), -0.7, 0.0);
        float bar = length(vec2(q.x, q.z)) - 0.1 - 0.02*a;
        d = (mod(a, 2.0) < 0.5) ? min(d, max(bar, abs(q.y) - 0.3)) : min(d, max(abs(q.x) + abs(q.z) - 0.14, abs(q.y) - 0.2));
    }
    int n = 0;
    for (int j = 1; j <= 3; ++j) {
        if (j == 2) continue;
        n += j;
        d = min(d, length(p - vec3(0.0, 0.9, 0.3*float(j))) - 0.05*float(n));
    }
    float floorHeight;
    if (p.x > 0.0) floorHeight = -1.2; else if (p.x > -1.0) floorHeight = -1.2 - 0.1*sin(p.x*3.14159265); else floorHeight = -1.2;
    return min(d, p.y - floorHeight + uGrow);
}

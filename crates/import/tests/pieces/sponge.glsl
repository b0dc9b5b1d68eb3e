// A cube with crosses taken out of it, again and again.
const int LEVELS = 3;
float sdBox(vec3 p, vec3 b) { vec3 d = abs(p) - b; return min(max(d.x,max(d.y,d.z)),0.0) + length(max(d,0.0)); }
float maxcomp(in vec3 p) { return max(p.x, max(p.y, p.z)); }
vec2 map(vec3 p) {
    float d = sdBox(p, vec3(1.0));
    float s = 1.0, m = 0.0;
    for (int i = 0; i < LEVELS; i++) {
        vec3 a = mod(p*s, 2.0) - 1.0;
        s *= 3.0;
        vec3 r = abs(1.0 - 3.0*abs(a));
        float da = max(r.x,r.y), db = max(r.y,r.z), dc = max(r.z,r.x);
        float c = (min(da, min(db, dc)) - 1.0)/s;
        if (c > d) {
            d = c;
            m = float(i);
        }
    }
    return vec2(d, m);
}

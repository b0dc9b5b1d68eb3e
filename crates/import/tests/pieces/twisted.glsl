// Matrices: p *= m is p * m, and a matrix has its columns one after the other.
struct Hit { float d; vec3 at; float id; };

mat2 rot(float a) { float c = cos(a), s = sin(a); return mat2(c, -s, s, c); }
mat3 frame(vec3 w) { vec3 u = normalize(cross(w, vec3(0.0, 1.0, 0.0))); return mat3(u, cross(u, w), w); }

Hit nearer(Hit a, Hit b) { if (a.d < b.d) return a; return b; }

float box(vec3 p, vec3 b) { vec3 d = abs(p) - b; return length(max(d, 0.0)) + min(max(d.x, max(d.y, d.z)), 0.0); }

Hit scene(vec3 p) {
    vec3 q = p;
    q.xz *= rot(0.8*p.y);
    q.xy = rot(0.3)*q.xy;
    Hit bar = Hit(0.7*box(q, vec3(0.3, 1.0, 0.5)), q, 1.0);
    mat3 m = frame(normalize(vec3(1.0, 0.4, 0.6)));
    vec3 s = m*(p - vec3(1.0, 0.2, 0.3));
    s = s*m*m;
    mat2 both = rot(0.4)*rot(0.5);
    s.yz = both*s.yz;
    Hit slab = Hit(box(s, vec3(0.5, 0.1, 0.3)), s, 2.0);
    return nearer(bar, slab);
}

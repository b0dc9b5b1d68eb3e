// Arithmetic of vectors, and functions of numbers.
float gyroid(vec3 p, float s, float t) { p *= s; return (abs(dot(sin(p), cos(p.zxy))) - t)/s; }
vec3 bend(vec3 p) { float k = 0.2; float c = cos(k*p.x), s = sin(k*p.x); mat2 m = mat2(c, -s, s, c); vec3 q = vec3(m*p.xy, p.z); return q; }
float ease(float x) { return x*x*x*(x*(x*6.0 - 15.0) + 10.0); }
float sceneSDF(vec3 p) {
    vec3 q = bend(p);
    float ball = length(q*vec3(1.0, 1.2, 0.9)) - 1.2;
    float g = gyroid(q, 4.0, 0.4)*0.5;
    float t = smoothstep(-0.6, 0.7, p.y);
    float wave = 0.05*sign(q.x + 10.0)*fract(0.25*(p.z + 8.0))*step(0.2, p.y + 3.0) + 0.01*exp(-p.x*p.x)*sqrt(abs(p.y) + 1.0);
    vec4 more = vec4(clamp(q, -0.5, 0.5), ease(clamp(p.z, 0.0, 1.0)));
    wave += 0.02*dot(more, vec4(0.1, 0.2, 0.3, 0.4)) + 0.01*reflect(q, normalize(vec3(1.0, 2.0, 2.0))).y;
    vec2 pair = vec2(2.0, 3.0); pair *= 0.5; pair.y += pair.x;
    wave -= 0.001*(pair.x + pair.y)*tan(0.2*q.z) + 0.001*length(pair);
    return max(ball, mix(g, -0.3*g - 0.02, t)) + wave;
}

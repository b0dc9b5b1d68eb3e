// A loop that each point leaves in its own round.
float DE(vec3 pos) {
    vec3 z = pos;
    float dr = 1.0;
    float r = 0.0;
    for (int i = 0; i < 5; i++) {
        r = length(z);
        if (r > 2.0) break;
        float theta = acos(z.z/r);
        float phi = atan(z.y, z.x);
        dr = pow(r, 7.0)*8.0*dr + 1.0;
        float zr = pow(r, 8.0);
        theta = theta*8.0;
        phi = phi*8.0;
        z = zr*vec3(sin(theta)*cos(phi), sin(phi)*sin(theta), cos(theta));
        z += pos;
    }
    return 0.5*log(r)*r/dr;
}

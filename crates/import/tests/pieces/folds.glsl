// Space folded by mirrors.
float de(vec3 p)
{
    const float scale = 2.0;
    vec3 offset = vec3(1.0, 1.0, 1.0);
    int n = 0;
    while (n < 6) {
        if (p.x + p.y < 0.0) p.xy = -p.yx;
        if (p.x + p.z < 0.0) p.xz = -p.zx;
        if (p.y + p.z < 0.0) p.zy = -p.yz;
        p = p*scale - offset*(scale - 1.0);
        n++;
    }
    return (length(p) - 1.6)*pow(scale, -float(n));
}

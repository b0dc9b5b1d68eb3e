// A distance and the number of a material.
precision highp float;

float sdPlane( in vec3 p ) { return p.y; }
float sdBox( vec3 p, vec3 b )
{
    vec3 d = abs(p) - b;
    return min(max(d.x, max(d.y, d.z)), 0.0) + length(max(d, 0.0));
}
float sdTorus( vec3 p, vec2 t ) { return length( vec2(length(p.xz) - t.x, p.y) ) - t.y; }
vec2 opU( vec2 d1, vec2 d2 ) { return (d1.x < d2.x) ? d1 : d2; }

#define ZERO (min(iFrame,0))

vec2 map( in vec3 pos )
{
    vec2 res = vec2( pos.y, 1.0 );
    if( pos.x < 3.0 )
    {
        res = opU( res, vec2( sdBox( pos - vec3(-1.0, 0.35, 0.0), vec3(0.35, 0.3, 0.25) ), 3.0 ) );
    }
    res = opU( res, vec2( sdTorus( (pos - vec3(0.4, 0.5, 0.0)).xzy, vec2(0.35, 0.1) ), 25.0 ) );
    res.x *= 0.9;
    return res;
}

vec3 calcNormal( in vec3 pos )
{
    vec3 n = vec3(0.0);
    for( int i = ZERO; i < 4; i++ )
    {
        vec3 e = 0.5773 * (2.0 * vec3((((i+3)>>1)&1), ((i>>1)&1), (i&1)) - 1.0);
        n += e * map(pos + 0.0005 * e).x;
    }
    return normalize(n);
}

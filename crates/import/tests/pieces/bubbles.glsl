// Balls that flow into each other over a floor.
#define SPEED 0.7

float smin(float a, float b, float k)
{
    float h = clamp(0.5 + 0.5 * (b - a) / k, 0.0, 1.0);
    return mix(b, a, h) - k * h * (1.0 - h);
}

float sdSphere(vec3 p, float s) { return length(p) - s; }

float map(vec3 p)
{
    vec3 q = p - vec3(0.5 * sin(iTime * SPEED + 0.3), 0.6, 0.0);
    float d = sdSphere(q, 0.5);
    d = smin(d, sdSphere(p - vec3(-0.6, 0.4, 0.2), 0.35), 0.25);
    return min(d, p.y + 0.1);
}

vec3 shade(vec3 p) { return texture(iChannel0, p.xy).xyz * dFdx(p.x); }

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec2 uv = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
    fragColor = vec4(shade(vec3(uv, 1.0)), 1.0);
}

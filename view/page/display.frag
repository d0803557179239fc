// From radiance to the screen: exposure, tone curve, sRGB, dither, as render/tone_map.cpp; and the
// edges of elements, where neighbouring pixels see different ones.
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;

uniform sampler2D light;      // sums over rays; alpha: how many, -1: a colour
uniform usampler2D elements;
uniform vec2 scale;       // pixels of `light` a pixel of the screen
uniform float per_white;  // one over the radiance shown as white
uniform int curve;        // 0 shoulder, 1 filmic, 2 reinhard, 3 linear
uniform bool edges;

out vec4 colour;

float film(float v) {
    return (v * (0.15 * v + 0.05) + 0.004) / (v * (0.15 * v + 0.5) + 0.06) - 1.0 / 15.0;
}

float tone(float s) {
    if (!(s > 0.0)) return 0.0;
    if (s >= 1.0) return 1.0;
    float x = 2.2 * s;
    if (curve == 1) return film(11.2 * s) / film(11.2);
    if (curve == 2) return x * (1.0 + x / (2.2 * 2.2)) / (1.0 + x);
    if (curve == 3) return min(x, 1.0);
    if (x <= 0.6) return x;
    float left = 1.0 - (x - 0.6) / 1.6;
    return 1.0 - 0.4 * left * left * left * left;
}

float encode(float l) {
    return l <= 0.0031308 ? 12.92 * l : 1.055 * pow(l, 1.0 / 2.4) - 0.055;
}

void main() {
    ivec2 last = textureSize(light, 0) - 1;
    ivec2 at = min(ivec2(gl_FragCoord.xy * scale), last);
    vec4 seen = texelFetch(light, at, 0);
    vec3 shown = seen.rgb;
    if (seen.a >= 0.0) {
        const float g = 1.32471795724474602596;
        float dither = dot(gl_FragCoord.xy, vec2(1.0 / g, 1.0 / (g * g)));
        for (int c = 0; c < 3; ++c) {
            float code = 255.0 * encode(tone(shown[c] / max(seen.a, 1.0) * per_white));
            shown[c] = floor(code + fract(dither + float(c) / 3.0)) / 255.0;
        }
    }
    if (edges) {
        uint here = texelFetch(elements, at, 0).r;
        bool differs = here != texelFetch(elements, min(at + ivec2(1, 0), last), 0).r ||
                       here != texelFetch(elements, min(at + ivec2(0, 1), last), 0).r;
        if (differs) shown = mix(shown, vec3(0.98, 0.62, 0.15), 0.75);
    }
    colour = vec4(shown, 1.0);
}

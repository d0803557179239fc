// Light along the ray of a pixel: a walk through the leaves, the integral of linear J in each in
// closed form, and the patch at the end. docs/guide/13-viewer.md; walk.js does the same on the CPU.
precision highp float;
precision highp int;
precision highp sampler2D;

uniform sampler2D zones, nodes, walls, patches, pieces, rows;
uniform vec3 eye, forward, right, up;  // right and up reach the picture's edges
uniform vec2 size, shift;              // of the whole picture, and within a pixel [pixel]
uniform vec3 hull_min, hull_max;
uniform float environment[BANDS];
// Layers that are shown, 1 or 0: emission, surfaces direct, surfaces indirect, single, multiple.
uniform float layers[5];
uniform bool medium;
uniform bool clip;
uniform vec4 clip_plane;    // what is where it is negative is cut away
uniform int clip_colours;   // 0 none, 1 level, 2 error, 3 J
uniform vec3 colour_scale;  // low, high, 1: by logarithms

flat in int entry;  // what the ray meets first
layout(location = 0) out vec4 radiance;  // alpha: 1, rays are counted; -1: it is a colour
layout(location = 1) out uint element;   // 2 × index + 1 of a patch, + 2 of a zone; 0 none

const int NODE = 2, FACES = 4, INFO = 5, LIGHT = 6;
const int PER_BAND = VARYING != 0 ? 3 : 2;
const int ZONE = LIGHT + PER_BAND * BANDS;
const int PATCH = 1 + BANDS, PIECE = 1 + BANDS;
const float FAR = 1e30;

vec4 texel(sampler2D table, int index) {
    return texelFetch(table, ivec2(index & (WIDTH - 1), index / WIDTH), 0);
}

float at(vec4 f, vec3 x) { return dot(f.xyz, x) + f.w; }

// From a rope to the leaf that holds the ray at distance t. A split plane is behind the ray as soon
// as t has come to it: the same division says so that ended the leaf before.
int descend(int rope, vec3 d, float t) {
    while (rope >= 0 && (rope & 3) == 1) {
        int base = NODE * (rope >> 2);
        vec4 plane = texel(nodes, base);
        float start = at(plane, eye), slope = dot(plane.xyz, d);
        bool second = slope == 0.0 ? start > 0.0 : (slope > 0.0) == (t >= -start / slope);
        vec4 children = texel(nodes, base + 1);
        rope = int(second ? children.y : children.x);
    }
    return rope;
}

int piece_at(int rope, vec3 x) {
    while (rope >= 0 && (rope & 3) == 1) {
        int base = NODE * (rope >> 2);
        vec4 children = texel(nodes, base + 1);
        rope = int(at(texel(nodes, base), x) > 0.0 ? children.y : children.x);
    }
    return rope;
}

// Weights of J where a segment of optical length tau begins and where it ends, and what it lets
// through.
vec3 segment_weights(float tau) {
    float opacity, back;
    if (tau < 0.05) {
        opacity = tau * (1.0 - tau * (1.0 / 2.0 - tau * (1.0 / 6.0 - tau / 24.0)));
        back = tau * (1.0 / 2.0 - tau * (1.0 / 3.0 - tau * (1.0 / 8.0 - tau / 30.0)));
    } else {
        opacity = 1.0 - exp(-tau);
        back = (opacity - tau * (1.0 - opacity)) / tau;
    }
    return vec3(opacity - back, back, 1.0 - opacity);
}

// The same for an extinction that is linear along the segment: its halves are not alike.
vec3 segment_weights(float first, float second) {
    float tau = first + second;
    vec3 w = segment_weights(tau);
    float excess = 2.0 / 3.0 * exp(-0.5 * tau) * (exp(0.5 * (second - first)) - 1.0);
    float moved = clamp(excess, -w.y, w.x);
    return vec3(w.x + -moved, w.y + moved, w.z);
}

vec3 map_colour(float t) {
    t = clamp(t, 0.0, 1.0);
    vec3 c = vec3(-5.4354559, 4.6458526, 26.3124352);
    c = c * t + vec3(4.7763850, -13.7451454, -65.3530326);
    c = c * t + vec3(6.2282699, 14.1799334, 56.6905526);
    c = c * t + vec3(-4.6342305, -5.7991010, -19.3324410);
    c = c * t + vec3(-0.3308618, 0.2148476, 0.0950952);
    c = c * t + vec3(0.1050930, 1.4046135, 1.3845902);
    return clamp(c * t + vec3(0.2777273, 0.0054073, 0.3340998), 0.0, 1.0);
}

float sum[BANDS], through[BANDS];

// What the ray gains in a leaf between two distances. False: so little is left that the rest does
// not show.
bool cross_zone(int base, int row, vec3 d, float t_in, float t_out) {
    vec3 x_in = eye + t_in * d, x_out = eye + t_out * d;
    float most = 0.0;
    for (int b = 0; b < BANDS; ++b) {
        vec2 optics = texel(rows, row * BANDS + b).xy;
        vec4 direct = texel(zones, base + LIGHT + PER_BAND * b);
        vec4 indirect = texel(zones, base + LIGHT + PER_BAND * b + 1);
#if VARYING
        vec4 extinction = texel(zones, base + LIGHT + PER_BAND * b + 2);
        float k_in = max(0.0, at(extinction, x_in)), k_out = max(0.0, at(extinction, x_out));
        float quarter = 0.25 * (t_out - t_in), k_half = 0.5 * (k_in + k_out);
        vec3 w = segment_weights(quarter * (k_in + k_half), quarter * (k_half + k_out));
#else
        vec3 w = segment_weights(optics.x * (t_out - t_in));
#endif
        // A function that fits may dip below zero at an end; what is gained does not.
        float single = max(0.0, dot(w.xy, vec2(at(direct, x_in), at(direct, x_out))));
        float multiple = max(0.0, dot(w.xy, vec2(at(indirect, x_in), at(indirect, x_out))));
        sum[b] += through[b] * (layers[0] * optics.y * (w.x + w.y) + layers[3] * single +
                                layers[4] * multiple);
        through[b] *= w.z;
        most = max(most, through[b]);
    }
    return most > 1e-7;
}

void leave() {
    for (int b = 0; b < BANDS; ++b) sum[b] += layers[0] * through[b] * environment[b];
}

void strike(int wall, vec3 x) {
    int rope = piece_at(int(texel(walls, wall).x), x);
    if (rope < 0) return;
    int piece = PIECE * (rope >> 2);
    int index = int(texel(pieces, piece).x), base = PATCH * index;
    int row = int(texel(patches, base).x);
    for (int b = 0; b < BANDS; ++b) {
        float emitted = texel(rows, row * BANDS + b).y;
        float direct = max(0.0, at(texel(pieces, piece + 1 + b), x));
        float indirect = max(0.0, at(texel(patches, base + 1 + b), x));
        sum[b] += through[b] * (layers[0] * emitted + layers[1] * direct + layers[2] * indirect);
    }
    element = uint(2 * index + 1);
}

// A zone on the clip plane, in the colours of what it holds.
void paint(int zone, vec3 x) {
    int base = ZONE * zone;
    vec4 info = texel(zones, base + INFO);
    int row = int(info.x);
    radiance = vec4(0.12, 0.12, 0.13, -1.0);  // a solid
    if (row < 0) return;
    float value = clip_colours == 1 ? info.z : info.w;
    if (clip_colours == 3) {
        value = 0.0;
        for (int b = 0; b < BANDS; ++b)
            value += (texel(rows, row * BANDS + b).y +
                      at(texel(zones, base + LIGHT + PER_BAND * b), x) +
                      at(texel(zones, base + LIGHT + PER_BAND * b + 1), x)) / float(BANDS);
    }
    float low = colour_scale.x, high = colour_scale.y;
    float t = colour_scale.z > 0.0 ? log(max(value, low) / low) / log(high / low)
                                   : (value - low) / (high - low);
    radiance = vec4(map_colour(t), -1.0);
    element = uint(2 * int(info.y) + 2);
}

// Where the ray begins to see (x), and where it ends on the clip plane (y).
vec2 clipped(vec3 d) {
    if (!clip) return vec2(0.0, FAR);
    float start = at(clip_plane, eye), slope = dot(clip_plane.xyz, d);
    float t = slope == 0.0 ? FAR : -start / slope;
    if (start >= 0.0) return vec2(0.0, t > 0.0 && clip_colours > 0 ? t : FAR);
    return vec2(slope > 0.0 ? t : FAR, FAR);
}

void walk(int rope, vec3 d, float t) {
    vec2 seen = clipped(d);
    rope = descend(rope, d, t);
    for (int step = 0; step < 20000; ++step) {
        if (rope < 0) {
            leave();
            return;
        }
        if ((rope & 3) == 2) {
            vec2 wall = texel(walls, rope >> 2).xy;
            if (t >= seen.x) {
                strike(rope >> 2, eye + t * d);
                return;
            }
            rope = descend(int(wall.y), d, t);
            continue;
        }
        int zone = rope >> 2, base = ZONE * zone, exit_face = 0;
        float t_out = FAR;
        for (int k = 0; k < 4; ++k) {
            vec4 plane = texel(zones, base + k);
            float slope = dot(plane.xyz, d);
            float t_face = slope < 0.0 ? -at(plane, eye) / slope : FAR;
            if (t_face < t_out) {
                t_out = t_face;
                exit_face = k;
            }
        }
        t_out = max(t, t_out);
        int row = int(texel(zones, base + INFO).x);
        if (t < seen.x && t_out >= seen.x) {
            t = seen.x;
            if (clip_colours > 0 && row != -1) {
                paint(zone, eye + t * d);
                return;
            }
        }
        if (t >= seen.x) {
            if (row == -2) return;
            if (t_out >= seen.y && row >= 0) {
                paint(zone, eye + seen.y * d);
                return;
            }
            if (row >= 0 && medium && t_out > t && !cross_zone(base, row, d, t, t_out)) return;
        }
        t = t_out;
        vec4 ropes = texel(zones, base + FACES);
        rope = descend(int(ropes[exit_face]), d, t);
    }
}

void main() {
    vec2 place = 2.0 * (gl_FragCoord.xy + shift) / size - 1.0;
    vec3 d = normalize(forward + place.x * right + place.y * up);
    // From outside the hull the ray begins where it enters.
    vec3 near = min((hull_min - eye) / d, (hull_max - eye) / d);
    float t = max(0.0, max(near.x, max(near.y, near.z)));
    for (int b = 0; b < BANDS; ++b) {
        sum[b] = 0.0;
        through[b] = 1.0;
    }
    element = 0u;
    radiance = vec4(0.0);
    walk(entry, d, all(lessThan(abs(eye - 0.5 * (hull_min + hull_max)),
                                0.5 * (hull_max - hull_min))) ? 0.0 : t);
    if (radiance.a < 0.0) return;
#if BANDS == 3
    radiance = vec4(sum[0], sum[1], sum[2], 1.0);
#else
    float mean = 0.0;
    for (int b = 0; b < BANDS; ++b) mean += sum[b] / float(BANDS);
    radiance = vec4(vec3(mean), 1.0);
#endif
}

#include "cli/scene_keys.h"

namespace tyndall::cli::keys {

const KeyTable& root() {
    static const KeyTable table{
        "top level",
        {
            {"format", "1", "required", "version of the file format"},
            {"title", "string", "\"\"", "shown in reports"},
            {"bands", "whole number, 1 to 64", "1",
             "values a spectrum has: 1 grey, 3 red, green, blue"},
            {"band_edges", "array of numbers [µm], the first may be 0, the last inf", "",
             "wavelengths between which the bands lie, one more than bands: temperatures emit by "
             "Planck's law"},
            {"grey_gases", "path of a file", "",
             "instead: the bands are a clear gas and the grey gases of this file, relative to the "
             "scene file"},
            {"material", "array of tables", "", "what surfaces are made of"},
            {"surface", "array of tables", "required", "geometry"},
            {"medium", "array of tables", "", "fog, smoke, haze"},
            {"light", "array of tables", "", "sun, point and spot lights"},
            {"environment", "table", "", "what comes in from outside"},
            {"camera", "array of tables", "", "cameras"},
            {"solve", "table", "", "how the light is computed"},
            {"render", "table", "", "how the picture is made"},
            {"animation", "table", "", "keys that change in time, for tyndall animate"},
        }};
    return table;
}

const KeyTable& material() {
    static const KeyTable table{
        "[[material]]",
        {
            {"name", "string", "required", "how surfaces speak of it"},
            {"reflectance", "number from 0 to 1, or one a band", "required", "Lambertian"},
            {"specular", "number from 0 to 1, or one a band", "0",
             "reflected about the mirror direction, beside reflectance: both add up to 1 at most"},
            {"roughness", "number from 0 to 1", "0", "of the specular part; 0: a mirror"},
            {"emission", "number [W/m²/sr], or one a band", "", "radiance"},
            {"exitance", "number [W/m²], or one a band", "", "π × radiance"},
            {"power", "number [W], or one a band", "", "of the whole surface"},
            {"temperature", "number [K]", "",
             "emits (1−ρ)σT⁴/π; with several bands each one's share of it"},
            {"flux", "number [W/m²], or one a band", "",
             "net flux out of the wall, which takes the temperature for that; 0 is adiabatic, "
             "below "
             "0 a sink; with band_edges or grey_gases one number, of all bands together"},
            {"emits", "\"front\" or \"both\"", "\"front\"; \"both\" with temperature or flux",
             "which sides emit"},
            {"back", "name of a material", "the same", "what the back side is made of"},
        }};
    return table;
}

const KeyTable& grey_gases() {
    static const KeyTable table{
        "file of grey gases",
        {
            {"format", "1", "required", "version of the file format"},
            {"title", "string", "", "for readers"},
            {"source", "string", "", "for readers: where the numbers come from"},
            {"temperatures", "[lowest, highest] [K]", "required",
             "between which the weights hold; beyond, those of the nearer are taken"},
            {"pressure", "\"atm\", \"bar\" or \"Pa\"", "required", "unit in absorption"},
            {"gas", "array of tables", "required",
             "1 to 63; the clear gas, which takes the rest of the weights, is added as band 0"},
        }};
    return table;
}

const KeyTable& grey_gas() {
    static const KeyTable table{
        "gas of a file of grey gases",
        {
            {"absorption", "number [1/m per pressure]", "required",
             "coefficient for a partial pressure of 1"},
            {"weights", "array of numbers [1, 1/K, 1/K², …]", "required",
             "b_0, b_1, …: the gas has the share Σ b_j T^j of a black body's power"},
        }};
    return table;
}

const KeyTable& surface() {
    static const KeyTable table{
        "[[surface]]",
        {
            {"name", "string", "required", "its faces are named name.face"},
            {"material", "name of a material", "none: an interface, light passes", ""},
            {"room", "table", "", "six faces that look inward: floor, ceiling, x0, x1, y0, y1"},
            {"box", "table", "", "six faces that look outward: bottom, top, x0, x1, y0, y1"},
            {"rectangle", "table", "", "corner, u, v; front = u × v"},
            {"polygons", "array of polygons [[x, y, z], …] [m]", "",
             "planar, any count of corners, front by the right-hand rule"},
            {"file", "path", "",
             "OBJ, PLY, STL or OFF, relative to the scene file; OBJ groups are faces"},
            {"scale", "number or [x, y, z]", "1", "applied first"},
            {"rotate", "table", "none", "applied second, about the origin"},
            {"translate", "[x, y, z] [m]", "[0, 0, 0]", "applied last"},
        }};
    return table;
}

const KeyTable& cuboid() {
    static const KeyTable table{
        "room, box",
        {
            {"min", "[x, y, z] [m]", "required", "lowest corner"},
            {"max", "[x, y, z] [m]", "required", "highest corner"},
            {"openings", "array of tables", "", "holes that light passes, named surface.opening"},
        }};
    return table;
}

const KeyTable& rectangle() {
    static const KeyTable table{
        "rectangle",
        {
            {"corner", "[x, y, z] [m]", "required", ""},
            {"u", "[x, y, z] [m]", "required", "first side"},
            {"v", "[x, y, z] [m]", "required", "second side, perpendicular to u"},
            {"openings", "array of tables", "", "holes that light passes, named surface.opening"},
        }};
    return table;
}

const KeyTable& opening() {
    static const KeyTable table{
        "openings of a rectangle",
        {
            {"name", "string", "required", ""},
            {"corner", "[s, t] [m]", "required", "along u and v from the corner"},
            {"size", "[ds, dt] [m]", "required", "along u and v"},
        }};
    return table;
}

const KeyTable& face_opening() {
    static const KeyTable table{"openings of a room or box",
                                {
                                    {"name", "string", "required", ""},
                                    {"face", "name of a face", "required",
                                     "floor, ceiling (bottom, top of a box), x0, x1, y0, y1"},
                                    {"corner", "[s, t] [m]", "required",
                                     "from the face's lowest corner along (y, z) of x0 and x1, (x, "
                                     "z) of y0 and y1, (x, y) of the others"},
                                    {"size", "[ds, dt] [m]", "required", "along the same axes"},
                                }};
    return table;
}

const KeyTable& rotate() {
    static const KeyTable table{"rotate",
                                {
                                    {"axis", "[x, y, z]", "required", "any length but 0"},
                                    {"degrees", "number", "required", "right-hand rule"},
                                }};
    return table;
}

const KeyTable& medium() {
    static const KeyTable table{
        "[[medium]]",
        {
            {"name", "string", "required", ""},
            {"extinction", "number [1/m], expression of x, y, z, or one of them a band; or table",
             "required; 0 with partial_pressure",
             "absorption + scattering; the same everywhere, or varying in space"},
            {"albedo", "number from 0 to 1, or one a band", "0", "scattering / extinction"},
            {"phase", "table", "isotropic", ""},
            {"emission", "number [W/m²/sr], or one a band", "", "J_e"},
            {"partial_pressure", "number [Pa]", "",
             "of the absorbing gases of grey_gases: their absorption comes to extinction"},
            {"temperature", "number [K]", "",
             "J_e = σT⁴/π; with several bands each one's share of it"},
            {"heat", "number [W/m³], or one a band", "",
             "a source instead; 0 is radiative equilibrium; with band_edges or grey_gases one "
             "number, of all bands together"},
            {"fills", "\"everywhere\"", "\"everywhere\" without at",
             "every region that is not solid"},
            {"at", "[x, y, z] [m]", "", "instead of fills: the region around this point"},
        }};
    return table;
}

const KeyTable& extinction() {
    static const KeyTable table{
        "extinction of a medium, as a table",
        {
            {"file", "path", "required",
             "array [x, y, z] of float32 or float64 in a .npy file, relative to the scene file"},
            {"min", "[x, y, z] [m]", "required", "place of its first value"},
            {"max", "[x, y, z] [m]", "required",
             "place of its last value; beyond there is nothing"},
            {"scale", "number [1/m], or one a band", "1", "by which the values are multiplied"},
        }};
    return table;
}

const KeyTable& phase() {
    static const KeyTable table{
        "phase",
        {{"henyey_greenstein", "number above -1 and below 1", "", "mean cosine g; or rayleigh"},
         {"rayleigh", "true", "", "particles much smaller than the wavelength"}}};
    return table;
}

const KeyTable& light() {
    static const KeyTable table{"[[light]]",
                                {
                                    {"name", "string", "required", ""},
                                    {"sun", "table", "", "a parallel beam, or a disc at infinity"},
                                    {"point", "table", "", ""},
                                    {"spot", "table", "", "a cone"},
                                }};
    return table;
}

const KeyTable& sun() {
    static const KeyTable table{
        "sun",
        {
            {"direction", "[x, y, z]", "required", "in which the light travels, any length but 0"},
            {"irradiance", "number [W/m²], or one a band", "required", "across the beam"},
            {"angle", "number from 0 to 90 [degrees]", "0", "angular diameter"},
        }};
    return table;
}

const KeyTable& point() {
    static const KeyTable table{"point",
                                {
                                    {"position", "[x, y, z] [m]", "required", ""},
                                    {"intensity", "number [W/sr], or one a band", "required", ""},
                                }};
    return table;
}

const KeyTable& spot() {
    static const KeyTable table{
        "spot",
        {
            {"position", "[x, y, z] [m]", "required", ""},
            {"direction", "[x, y, z]", "", "axis of the cone; or target"},
            {"target", "[x, y, z] [m]", "", "a point on the axis; or direction"},
            {"intensity", "number [W/sr], or one a band", "required", "inside the cone"},
            {"angle", "number above 0, up to 180 [degrees]", "required", "full opening angle"},
            {"soft_edge", "number from 0 to 90 [degrees]", "0",
             "outside the cone, over which light fades"},
        }};
    return table;
}

const KeyTable& environment() {
    static const KeyTable table{
        "[environment]",
        {{"radiance", "number [W/m²/sr], or one a band", "0", "from all directions"}}};
    return table;
}

const KeyTable& camera() {
    static const KeyTable table{
        "[[camera]]",
        {
            {"name", "string", "required", ""},
            {"eye", "[x, y, z] [m]", "required", ""},
            {"target", "[x, y, z] [m]", "required", "shown in the picture's centre"},
            {"up", "[x, y, z]", "[0, 0, 1]", "not along the view"},
            {"projection", "\"perspective\", \"orthographic\" or \"panorama\"", "perspective",
             "panorama: all around, longitude across and latitude upright"},
            {"fov_x", "number above 0 and below 180 [degrees]", "",
             "whole angle across, of perspective pictures; or fov_y"},
            {"fov_y", "number above 0 and below 180 [degrees]", "",
             "whole angle upright; or fov_x"},
            {"extent_x", "number above 0 [m]", "",
             "whole length across, of orthographic pictures; or extent_y"},
            {"extent_y", "number above 0 [m]", "", "whole length upright; or extent_x"},
            {"lens", "table", "a pinhole", "what is out of focus is blurred"},
            {"width", "whole number, 1 to 65536 [pixel]", "640", ""},
            {"height", "whole number, 1 to 65536 [pixel]", "480, of a panorama width/2", ""},
        }};
    return table;
}

const KeyTable& lens() {
    static const KeyTable table{"camera.lens",
                                {{"diameter", "number above 0 [m]", "required", ""},
                                 {"focus", "number above 0 [m]", "required",
                                  "distance of the sharp plane from the eye, along the view"}}};
    return table;
}

const KeyTable& animation() {
    static const KeyTable table{"[animation]",
                                {
                                    {"frames", "whole number, 1 to 10000", "required", ""},
                                    {"fps", "number above 0", "24", "frames a second"},
                                    {"track", "array of tables", "", "a key each that changes"},
                                }};
    return table;
}

const KeyTable& animation_track() {
    static const KeyTable table{
        "[[animation.track]]",
        {
            {"key", "string", "required",
             "any key that --set takes: \"material.lamp.emission\", \"light.sun.sun.direction\""},
            {"frames", "array of numbers", "", "keyframes, ascending, from 0; or times"},
            {"times", "array of numbers [s]", "", "keyframes, ascending, from 0; or frames"},
            {"values", "array", "required",
             "one a keyframe: numbers, arrays of numbers of one shape, or strings (with "
             "\"step\")"},
            {"interpolation", "\"linear\", \"smooth\" or \"step\"", "\"linear\"",
             "straight between keyframes; with slope 0 at them; each value until the next one"},
        }};
    return table;
}

}  // namespace tyndall::cli::keys

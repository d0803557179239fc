#include "cli/study_keys.h"

namespace tyndall::cli::keys {

const KeyTable& study() {
    static const KeyTable table{
        "top level of a study",
        {
            {"scene", "path", "required", "the scene file, relative to the study file"},
            {"title", "string", "the file's name", "heads the summary"},
            {"reference", "path, table of overrides, or table with one of these a measure",
             "required",
             "picture (.pfm, .exr), solution (.vtkhdf, or a run's folder), probe values (.csv), or "
             "{ \"solve.error\" = 0.001 }: a finer run, made once"},
            {"measure",
             "array of \"picture\", \"single_scattering\", \"surfaces\", \"media\", "
             "\"probe\"",
             "[\"picture\"]", "what is compared with the reference"},
            {"axes", "table, or array of tables", "required",
             "--set keys with an array of values each; every combination is run"},
            {"set", "table", "none", "--set keys with one value each, for every run"},
            {"errors", "array of numbers above 0 and below 1", "[]",
             "for which the elements that each curve needs are told"},
            {"probe", "table", "", "where \"probe\" measures"},
            {"slice", "table", "", "the plane of the slice pictures"},
        }};
    return table;
}

const KeyTable& study_probe() {
    static const KeyTable table{
        "[probe]",
        {
            {"points", "path of a CSV file", "chosen in media and on sides",
             "x,y,z or x,y,z,nx,ny,nz; not with probe values as the reference"},
            {"count", "whole number", "128", "points chosen in the media, and as many on sides"},
            {"rays", "whole number", "1024", "gathered along at each point"},
        }};
    return table;
}

const KeyTable& study_slice() {
    static const KeyTable table{
        "[slice]",
        {
            {"point", "[x, y, z] [m]", "required", "on the plane"},
            {"normal", "[x, y, z]", "required", "across the plane, any length but 0"},
        }};
    return table;
}

const KeyTable& study_axes() {
    static const KeyTable table{"[axes], or [[axes]] for several matrices",
                                {
                                    {"name", "string", "none", "of the matrix, in the legends"},
                                    {"along", "key of an axis with numbers",
                                     "the one with most values", "what each curve follows"},
                                }};
    return table;
}

}  // namespace tyndall::cli::keys

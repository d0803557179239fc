// What a solve of a scene will do, said in sentences.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/job.h"

namespace tyndall::cli {

// A medium, as light sees it. Mean chord 4V/S: the mean way through it, along straight lines that
// its walls end.
struct MediumThickness {
    std::string name;
    double chord = 0.0;                     // [m]
    double thinnest = 0.0, thickest = 0.0;  // extinction × chord, of the bands [-]
    double albedo = 0.0;                    // mean over bands [-]
};
std::vector<MediumThickness> media_thickness(const radiosity::Enclosure& enclosure);

// "thin: optical thickness 0.3 along its mean chord of 2.2 m; …"
std::string in_words(const MediumThickness& medium);

// Lines "label", "sentence": where the mesh begins, how it is refined and to which goal, for whom,
// by which methods, with which bands.
std::vector<std::pair<std::string, std::string>> solve_in_words(
    const SceneFile& file, const radiosity::Enclosure& enclosure);

}  // namespace tyndall::cli

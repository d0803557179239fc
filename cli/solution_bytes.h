// What a solution takes of memory, measured on the example scenes: good within a factor of two.
#pragma once

namespace tyndall::cli {

inline constexpr double leaf_bytes = 800.0;
inline constexpr double leaf_band_bytes = 300.0;  // more for each band
inline constexpr double entry_bytes = 8.0;        // of a row: column and value
inline constexpr double moment_bytes = 12.0;      // of an entry, where elements are linear
inline constexpr double smoothing_bytes = 37.0;   // beside these while rows are smoothed

}  // namespace tyndall::cli

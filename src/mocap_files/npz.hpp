// NumPy's npz: a zip of arrays.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace pmg::mocap {

struct NpyArray {
  std::vector<std::size_t> shape;  ///< empty: one number
  std::vector<double> values;      ///< row by row; empty if the array is no numbers (text, objects)
};

/// The arrays by name, without ".npy". Zip (APPNOTE 6.3: stored or deflated entries, no zip64, no encryption) and
/// npy 1.0 to 3.0: little-endian floats and integers. Throws ConfigError with file and byte. Of the libraries in
/// Debian, libcnpy isn't packaged, and libzip and minizip read files rather than bytes and know no npy; zlib does the
/// inflating.
std::map<std::string, NpyArray> parse_npz(const std::string& file, const std::string& bytes);

}  // namespace pmg::mocap

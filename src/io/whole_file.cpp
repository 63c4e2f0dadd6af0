#include "io/whole_file.hpp"

#include <fstream>
#include <stdexcept>

namespace pmg::io {

void write_whole_file(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path unfinished = file.string() + ".part";
  std::ofstream stream(unfinished, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + " cannot be written");
  std::filesystem::rename(unfinished, file);
}

}  // namespace pmg::io

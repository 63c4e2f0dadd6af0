#include "mocap_files/key_bodies.hpp"

#include "files/config_folders.hpp"
#include "files/config_reader.hpp"

namespace pmg::mocap {
namespace fs = std::filesystem;

const std::array<const char*, kKeyBodies> kKeyBodyNames = {
    "pelvis",      "neck",          "head",           "left_hip",   "right_hip",   "left_knee",
    "right_knee",  "left_ankle",    "right_ankle",    "left_heel",  "right_heel",  "left_toe",
    "right_toe",   "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist",
    "right_wrist", "left_asis",     "right_asis",     "left_psis",  "right_psis"};

NameTable read_name_table(const fs::path& file) {
  files::ConfigReader reader = files::ConfigReader::from_file(file);
  NameTable table;
  for (std::size_t b = 0; b < kKeyBodies; ++b) table[b] = reader.required<std::vector<std::string>>(kKeyBodyNames[b]);
  reader.finish();
  return table;
}

fs::path default_name_table() { return files::config_file("mocap", "table of names", "names"); }

std::string plain_name(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  std::string plain;
  for (const char c : colon == std::string::npos ? name : name.substr(colon + 1)) {
    if (c >= 'A' && c <= 'Z') plain += static_cast<char>(c + 32);
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) plain += c;
  }
  return plain;
}

}  // namespace pmg::mocap

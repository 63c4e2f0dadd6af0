#include "model/bundle.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "files/bounded_file.hpp"
#include "files/config_reader.hpp"
#include "model/clip_library_file.hpp"

namespace pmg::model {

namespace {

namespace fs = std::filesystem;

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1)
      throw std::runtime_error("SHA-256 is not available in this OpenSSL");
  }
  void add(std::string_view bytes) {
    if (EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) != 1)
      throw std::runtime_error("SHA-256 can't be computed");
  }
  std::string hex() {
    std::array<unsigned char, 32> digest{};
    if (EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr) != 1)
      throw std::runtime_error("SHA-256 can't be computed");
    std::string text;
    for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

void add_file(const fs::path& path, Sha256& hash) {
  files::expect_bounded_file(path, files::kLargestTable_bytes, "a file of a robot");
  std::ifstream file(path, std::ios::binary);
  std::array<char, 65536> block{};
  while (file.read(block.data(), block.size()) || file.gcount() > 0) {
    hash.add({block.data(), static_cast<std::size_t>(file.gcount())});
  }
  if (!file.is_open() || file.bad()) files::raise({path.string()}, "", "can't be read", "a readable file");
}

std::string hash_of_file(const fs::path& path) {
  Sha256 hash;
  add_file(path, hash);
  return hash.hex();
}

std::vector<fs::path> regular_files(const fs::path& directory) {
  std::vector<fs::path> files;
  if (!fs::is_directory(directory)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  return files;
}

/// Reads only this key: load_robot has checked the file already.
std::string urdf_name(const fs::path& robot_yaml) {
  return files::ConfigReader::from_file(robot_yaml).required<std::string>("urdf");
}

}  // namespace

Bundle bundle(const RobotModel& robot, const fs::path& clips, const std::vector<fs::path>& policies) {
  Bundle result;
  const auto add = [&result](const std::string& name, const fs::path& file) {
    result.files.emplace_back(name, hash_of_file(file));
  };
  const auto add_all = [&add](const std::string& folder, const std::vector<fs::path>& files) {
    for (const fs::path& file : files) add(folder + "/" + file.filename().string(), file);
  };
  const fs::path robot_yaml = robot.directory / "robot.yaml";
  const std::string urdf = urdf_name(robot_yaml);
  add("robot.yaml", robot_yaml);
  add(urdf, robot.directory / urdf);
  if (!clips.empty()) add_all("clips", clip_library_files(clips));
  add_all("policies", policies);
  add_all("calibration", regular_files(robot.directory / "calibration"));
  std::ranges::sort(result.files);

  Sha256 hash;
  for (const auto& [name, sha256] : result.files) hash.add(fmt::format("{}  {}\n", sha256, name));
  result.sha256 = hash.hex();
  return result;
}

std::string files_sha256(std::vector<fs::path> files) {
  std::ranges::sort(files, {}, [](const fs::path& file) { return file.filename(); });
  Sha256 hash;
  for (const fs::path& file : files) {
    std::error_code unreadable;  // add_file reports it
    hash.add(fmt::format("{}\n{}\n", file.filename().string(), fs::file_size(file, unreadable)));
    add_file(file, hash);
  }
  return hash.hex();
}

std::string clip_library_sha256(const fs::path& clips) { return files_sha256(clip_library_files(clips)); }

}  // namespace pmg::model

#include "drives/drive_type.hpp"

#include <fmt/format.h>

namespace pmg::drives {

void check_cover(const Cover& cover, const std::string& joint, const std::string& drive,
                 const files::ConfigReader& reader) {
  if (cover.needs <= cover.covers) return;
  reader.fail("bus",
              fmt::format("the drive '{}' covers a {} of {:g} and {}'s {} needs {:g} at the motor", drive, cover.field,
                          cover.covers, joint, cover.what, cover.needs),
              fmt::format("a drive whose {} is {:g} or more", cover.field, cover.needs));
}

}  // namespace pmg::drives

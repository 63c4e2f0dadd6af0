#include "drive_protocols/standard_drives.hpp"

#include "drive_protocols/canopen_drive.hpp"
#include "drive_protocols/damiao.hpp"
#include "drive_protocols/mini_cheetah.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "drive_protocols/robstride.hpp"

namespace pmg::drives {

DriveCatalogue standard_drives() {
  DriveCatalogue catalogue;
  catalogue.add("mit", [](files::ConfigReader& reader) { return std::make_shared<MitDrive>(read_mit_ranges(reader)); });
  catalogue.add("cubemars",
                [](files::ConfigReader& reader) { return std::make_shared<MitDrive>(read_mit_ranges(reader)); });
  catalogue.add("damiao",
                [](files::ConfigReader& reader) { return std::make_shared<DamiaoDrive>(read_mit_ranges(reader)); });
  catalogue.add("mini_cheetah", [](files::ConfigReader& reader) {
    return std::make_shared<MiniCheetahDrive>(read_mit_ranges(reader));
  });
  catalogue.add("robstride", [](files::ConfigReader& reader) {
    return std::make_shared<RobstrideDrive>(read_mit_ranges(reader, RobstrideDrive::kReplyId));
  });
  catalogue.add("cia402",
                [](files::ConfigReader& reader) { return std::make_shared<CanopenDrive>(read_cia402(reader)); });
  return catalogue;
}

}  // namespace pmg::drives

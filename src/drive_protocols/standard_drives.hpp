// The protocols of this project, by their names in robot.yaml.
#pragma once

#include "drives/drive_catalogue.hpp"

namespace pmg::drives {

DriveCatalogue standard_drives();

}  // namespace pmg::drives

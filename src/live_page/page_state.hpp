// What a page shows, as JSON: the robot's news, what is asked of it, and why it doesn't move.
#pragma once

#include <string>

#include "arms_operator/arms_board.hpp"
#include "live_page/heard_camera.hpp"
#include "live_page/measured_motion.hpp"
#include "live_page/page_devices.hpp"
#include "operator/driving_station.hpp"

namespace pmg::live_page {

/// For all pages: an object without its closing brace. measured: null: the robot's model isn't known. camera: null:
/// pages don't show it.
std::string shared_state(const ops::DrivingStation& station, const PageDevices& devices, const ops::ArmsBoard& arms,
                         const MeasuredMotion* measured, const HeardCamera* camera, std::int64_t now_ns);

/// (shared_state()) => the text for one page, with what concerns it alone.
std::string page_state(const std::string& shared, const web::Page& page, const PageDevices& devices);

}  // namespace pmg::live_page

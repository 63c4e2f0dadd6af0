#include "drive_output.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::literature {

namespace {

/// The most torque towards that side at that speed.
double available_Nm(const Machine::Drive& d, double towards, double speed_rad_s) {
  const double along_rad_s = towards * speed_rad_s;
  switch (d.speed_form) {
    case SpeedForm::kLine:
      return std::isfinite(d.stall_torque_Nm)
                 ? d.stall_torque_Nm * std::clamp(1.0 - along_rad_s / d.no_load_rad_s, 0.0, 1.0)
                 : kNever;
    case SpeedForm::kPower:
      return along_rad_s > 0.0 ? d.power_W / along_rad_s : kNever;
    case SpeedForm::kCut:
      return d.stall_torque_Nm * std::clamp(10.0 * (1.0 - along_rad_s / d.no_load_rad_s), 0.0, 1.0);
  }
  return kNever;
}

}  // namespace

double drive_torque_Nm(const Machine& machine, const DriveOutput& output, double torque_scale, double angle_rad,
                       double speed_rad_s) {
  const Machine::Drive& d = machine.drive;
  double torque_Nm = torque_scale * d.torque_factor * (output.held_Nm - output.emf_slope * speed_rad_s);
  if (d.saturation_per_Nm > 0.0) torque_Nm /= 1.0 + d.saturation_per_Nm * std::abs(torque_Nm);
  const double towards = torque_Nm >= 0.0 ? 1.0 : -1.0;
  const bool limited = std::isfinite(d.stall_torque_Nm) || std::isfinite(d.power_W);
  const double most_Nm = std::min(output.most_Nm, limited ? available_Nm(d, towards, speed_rad_s) : kNever);
  torque_Nm = towards * std::min(std::abs(torque_Nm), most_Nm);
  const Machine::Ripple& r = machine.ripple;
  if (r.current_share != 0.0) {
    torque_Nm *= 1.0 + r.current_share * std::sin(r.cogging_order * angle_rad + r.cogging_phase_rad);
  }
  return torque_Nm;
}

}  // namespace pmg::literature

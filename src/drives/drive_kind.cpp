#include "drives/drive_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmg::drives {

namespace {

MitRanges read_mit(files::ConfigReader& reader) {
  return {.position_rad = reader.required<double>("position_rad", files::positive()),
          .velocity_rad_s = reader.required<double>("velocity_rad_s", files::positive()),
          .torque_Nm = reader.required<double>("torque_Nm", files::positive()),
          .kp_Nm_per_rad = reader.required<double>("kp_Nm_per_rad", files::positive()),
          .kd_Nm_s_per_rad = reader.required<double>("kd_Nm_s_per_rad", files::positive()),
          .reply_id = static_cast<std::uint32_t>(reader.optional<int>("reply_id", 0, files::in_range(0, 0x7FF)))};
}

Cia402Settings read_cia402(files::ConfigReader& reader) {
  constexpr double kMost32 = std::numeric_limits<std::int32_t>::max();
  Cia402Settings settings;
  const bool torque = reader.one_of("mode", {"torque", "position"}) == "torque";
  settings.mode = torque ? Cia402Mode::kTorque : Cia402Mode::kPosition;
  settings.counts_per_turn = reader.required<double>("counts_per_turn", files::in_range(1.0, kMost32));
  settings.velocity_unit_rad_s = reader.required<double>("velocity_unit_rad_s", files::positive());
  settings.rated_torque_Nm = reader.required<double>("rated_torque_Nm", files::positive());
  settings.largest_torque_Nm = reader.required<double>("torque_Nm", files::positive());
  if (!torque) {
    settings.kp_Nm_per_rad = reader.required<double>("kp_Nm_per_rad", files::positive());
    settings.kd_Nm_s_per_rad = reader.required<double>("kd_Nm_s_per_rad", files::non_negative());
  }
  settings.vendor_id =
      static_cast<std::uint32_t>(reader.optional<double>("vendor_id", 0, files::in_range(0, 0xFFFFFFFFU)));
  settings.product_code =
      static_cast<std::uint32_t>(reader.optional<double>("product_code", 0, files::in_range(0, 0xFFFFFFFFU)));
  settings.temperature_index =
      static_cast<std::uint16_t>(reader.optional<int>("temperature_index", 0, files::in_range(0x2000, 0x9FFF)));
  settings.temperature_subindex =
      static_cast<std::uint8_t>(reader.optional<int>("temperature_subindex", 0, files::in_range(0, 255)));
  settings.temperature_unit_degC = reader.optional<double>("temperature_unit_degC", 1.0, files::positive());
  return settings;
}

struct Cover {
  const char *field, *what;
  double needs, covers;
};

void check(const Cover& cover, const std::string& joint, const std::string& drive, const files::ConfigReader& reader) {
  if (cover.needs <= cover.covers) return;
  reader.fail("bus",
              fmt::format("the drive '{}' covers a {} of {:g} and {}'s {} needs {:g} at the motor", drive, cover.field,
                          cover.covers, joint, cover.what, cover.needs),
              fmt::format("a drive whose {} is {:g} or more", cover.field, cover.needs));
}

}  // namespace

DriveKind read_drive_kind(files::ConfigReader reader) {
  const bool mit = reader.one_of("protocol", {"mit", "cia402"}) == "mit";
  const DriveKind kind = mit ? DriveKind(read_mit(reader)) : DriveKind(read_cia402(reader));
  reader.finish();
  return kind;
}

void check_covers(const DriveKind& kind, const DriveNeeds& needs, const std::string& joint, const std::string& drive,
                  const files::ConfigReader& reader) {
  const double range_rad = std::max(std::abs(needs.limits.q_lower_rad), std::abs(needs.limits.q_upper_rad));
  if (const auto* mit = std::get_if<MitRanges>(&kind)) {
    for (const Cover& cover : {Cover{"position_rad", "range", range_rad, mit->position_rad},
                               Cover{"velocity_rad_s", "speed limit", needs.limits.dq_rad_s, mit->velocity_rad_s},
                               Cover{"torque_Nm", "effort", needs.limits.torque_Nm, mit->torque_Nm},
                               Cover{"kp_Nm_per_rad", "kp", needs.gains.kp_Nm_per_rad, mit->kp_Nm_per_rad},
                               Cover{"kd_Nm_s_per_rad", "kd", needs.gains.kd_Nm_s_per_rad, mit->kd_Nm_s_per_rad}}) {
      check(cover, joint, drive, reader);
    }
    return;
  }
  const auto& settings = std::get<Cia402Settings>(kind);
  constexpr double kMost16 = std::numeric_limits<std::int16_t>::max(),
                   kMost32 = std::numeric_limits<std::int32_t>::max();
  check({"torque_Nm", "effort", needs.limits.torque_Nm, settings.largest_torque_Nm}, joint, drive, reader);
  check({"torque (32.767 times rated_torque_Nm)", "effort", needs.limits.torque_Nm,
         1e-3 * kMost16 * settings.rated_torque_Nm},
        joint, drive, reader);
  check({"position in 32 bits", "range", range_rad, kMost32 * settings.count_rad()}, joint, drive, reader);
  if (settings.mode == Cia402Mode::kTorque) return;
  const auto same = [](double a, double b) { return std::abs(a - b) <= Cia402Axis::kSameGains * b; };
  if (same(needs.gains.kp_Nm_per_rad, settings.kp_Nm_per_rad) &&
      same(needs.gains.kd_Nm_s_per_rad, settings.kd_Nm_s_per_rad))
    return;
  reader.fail("bus",
              fmt::format("the drive '{}' closes its position loop with kp {:g} and kd {:g}; {}'s gains are {:g} and "
                          "{:g} at the motor",
                          drive, settings.kp_Nm_per_rad, settings.kd_Nm_s_per_rad, joint, needs.gains.kp_Nm_per_rad,
                          needs.gains.kd_Nm_s_per_rad),
              "the drive's own gains, or `mode: torque`");
}

}  // namespace pmg::drives

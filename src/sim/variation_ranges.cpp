#include "sim/variation_ranges.hpp"

#include <string>
#include <utility>
#include <vector>

#include "files/config_reader.hpp"

namespace pmg::sim {

namespace {

enum class Missing { kKeepsItsValue, kIsAnError };

/// One mapping of the file.
class Keys {
 public:
  Keys(files::ConfigReader reader, Missing missing) : reader_(std::move(reader)), missing_(missing) {}

  void range(const char* key, Range& to, const files::NumberCheck& check) {
    if (!reads<std::vector<double>>(key)) return;
    const std::vector<double> ends = reader_.numbers(key, 2, check);
    if (ends[0] > ends[1]) reader_.fail(key, "runs backwards", "[lower, upper]");
    to = {ends[0], ends[1]};
  }
  template <typename T>
  void number(const char* key, T& to, const files::NumberCheck& check) {
    if (reads<T>(key)) to = reader_.required<T>(key, check);
  }
  /// A mapping of any names to numbers.
  void numbers(const char* key, const files::NumberCheck& check) {
    if (!reads<std::string>(key)) return;
    files::ConfigReader named = reader_.map(key);
    for (const std::string& name : named.keys()) named.required<double>(name, check);
    named.finish();
  }
  template <typename Read>
  void group(const char* key, Read&& read) {
    if (!reads<std::string>(key)) return;
    Keys within(reader_.map(key), missing_);
    read(within);
    within.reader_.finish();
  }
  void finish() const { reader_.finish(); }

 private:
  /// Whether to go on with this key. The reader hears of a missing one too: it names the known keys beside an unknown
  /// one.
  template <typename T>
  bool reads(const char* key) {
    if (missing_ == Missing::kIsAnError || reader_.has(key)) return true;
    reader_.optional<T>(key, {});
    return false;
  }

  files::ConfigReader reader_;
  Missing missing_;
};

/// Training's own groups: its Python code uses the numbers.
void check_kicks(Keys& keys) {
  Range range;
  double number = 0.0;
  int iterations = 0;
  keys.range("every_s", range, files::positive());
  for (const char* speed : {"linear_m_s", "vertical_m_s", "angular_rad_s"}) {
    keys.number(speed, number, files::non_negative());
  }
  keys.number("from_share", number, files::in_range(0.0, 1.0));
  keys.number("ramp_iterations", iterations, files::positive());
}

void check_upper_body(Keys& keys) {
  Range range;
  double share = 0.0;
  keys.number("share", share, files::in_range(0.0, 1.0));
  keys.range("frequency_Hz", range, files::positive());
  keys.numbers("amplitude_rad", files::non_negative());
}

VariationRanges read(const std::filesystem::path& file, Missing missing) {
  Keys keys(files::ConfigReader::from_file(file), missing);
  VariationRanges ranges;
  const files::NumberCheck any = files::any_number(), positive = files::positive(), some = files::non_negative();
  keys.range("friction", ranges.friction, positive);
  keys.range("torso_mass_kg", ranges.torso_mass_kg, any);
  keys.number("torso_center_of_mass_m", ranges.torso_center_of_mass_m, some);
  keys.range("hand_payload_kg", ranges.hand_payload_kg, some);
  keys.number("payload_share", ranges.payload_share, files::in_range(0.0, 1.0));
  keys.range("link_mass_factor", ranges.link_mass_factor, positive);
  keys.range("armature_factor", ranges.armature_factor, positive);
  keys.range("joint_friction_factor", ranges.joint_friction_factor, some);
  keys.range("kp_factor", ranges.kp_factor, positive);
  keys.range("kd_factor", ranges.kd_factor, positive);
  keys.range("delay_s", ranges.delay_s, files::in_range(0.0, 0.2));
  keys.number("encoder_offset_rad", ranges.encoder_offset_rad, some);
  keys.group("noise", [&](Keys& noise) {
    noise.number("gyro_rad_s", ranges.gyro_noise_rad_s, some);
    noise.number("gravity_direction", ranges.gravity_direction_noise, some);
    noise.number("q_rad", ranges.encoder_noise_rad, some);
    noise.number("dq_rad_s", ranges.velocity_noise_rad_s, some);
  });
  keys.group("kicks", check_kicks);
  keys.group("upper_body", check_upper_body);
  keys.finish();
  return ranges;
}

}  // namespace

VariationRanges load_variation_ranges(const std::filesystem::path& file) { return read(file, Missing::kKeepsItsValue); }

void check_training_ranges(const std::filesystem::path& file) { read(file, Missing::kIsAnError); }

}  // namespace pmg::sim

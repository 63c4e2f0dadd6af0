#include "robot_diagnosis/robot_options.hpp"

namespace pmg::robot_diagnosis {

namespace {

void add_sizes(const RobotCauseSizes& c, std::vector<evidence::Option>& all) {
  const auto add = [&](const std::string& name, const CauseSize& size, const char* unit) {
    const char* assumed = "assumed";
    all.push_back(
        {"causes." + name + ".wide", size.wide, unit, "standard deviation of the prior of this cause", assumed});
    all.push_back({"causes." + name + ".relevant", size.relevant, unit, "smallest error worth reporting", assumed});
  };
  add("torso_payload_kg", c.torso_payload_kg, "kg");
  add("hand_payload_kg", c.hand_payload_kg, "kg");
  add("torso_center_m", c.torso_center_m, "m");
  add("imu_rad", c.imu_rad, "rad");
  add("kp_share", c.kp_share, "");
  add("kd_share", c.kd_share, "");
  add("coulomb_share", c.coulomb_share, "");
  add("viscous_share", c.viscous_share, "");
  add("armature_share", c.armature_share, "");
  add("zero_offset_rad", c.zero_offset_rad, "rad");
  add("delay_s", c.delay_s, "s");
}

}  // namespace

std::vector<evidence::Option> listed(const RobotDiagnosisOptions& o) {
  const char* robots = "hidden robots, seeds 0 to 39";  // docs/explanation/whole-robot-diagnosis.md
  const char* assumed = "assumed; a series of measured robots would say better";
  const char* physics = "MuJoCo's soft contacts";
  const RobotTolerances& t = o.tolerances;
  const RobotCauseSizes& c = o.causes;
  const EvidenceOptions& e = o.evidence;
  const SupportOptions& s = o.support;
  const GroundOptions& g = o.ground;
  const NoiseOptions& n = e.noise;
  std::vector<evidence::Option> all = {
      {"tolerances.link_mass_share", t.link_mass_share, "",
       "standard deviation of a link's mass between robots of a kind", assumed},
      {"tolerances.payload_kg", t.payload_kg, "kg", "of the mass of torso and hands", assumed},
      {"tolerances.torso_center_m", t.torso_center_m, "m", "of the torso's centre of mass", assumed},
      {"tolerances.imu_rad", t.imu_rad, "rad", "of the IMU's mounting", assumed},
      {"tolerances.kp_share", t.kp_share, "", "of a gain", assumed},
      {"tolerances.kd_share", t.kd_share, "", "of a damping gain", assumed},
      {"tolerances.friction_share", t.friction_share, "", "of a joint's friction", assumed},
      {"tolerances.friction_least_Nm", t.friction_least_Nm, "Nm", "of small dry friction", assumed},
      {"tolerances.armature_share", t.armature_share, "", "of a rotor's inertia", assumed},
      {"tolerances.inertia_share", t.inertia_share, "",
       "of the inertia that a joint moves: only its sum with the rotor's shows", assumed},
      {"tolerances.zero_offset_rad", t.zero_offset_rad, "rad", "of a joint's zero", assumed},
      {"tolerances.delay_s", t.delay_s, "s", "of a command's delay", assumed},
      {"causes.coulomb_least_of_effort", c.coulomb_least_of_effort, "",
       "share of a joint's torque limit that a smaller dry friction is replaced by, where causes are sized by it",
       assumed},
      {"causes.viscous_least_Nm_s_per_rad", c.viscous_least_Nm_s_per_rad, "Nm s/rad", "the same of viscous friction",
       assumed},
      {"causes.armature_least_kg_m2", c.armature_least_kg_m2, "kg m^2", "the same of a rotor's inertia", assumed},
      {"causes.lightest_link_kg", c.lightest_link_kg, "kg", "the mass of a lighter link has no tolerance", assumed},
      {"evidence.least_log_evidence", e.least_log_evidence, "",
       "natural logarithm: a cause must make the data so much more probable, among some two hundred candidates",
       robots},
      {"evidence.share_in_folds", e.share_in_folds, "", "share of it that must remain whichever block is left out",
       assumed},
      {"evidence.told_apart", e.told_apart, "", "log evidence between two causes below which neither is preferred",
       robots},
      {"evidence.most_findings", e.most_findings, "", "causes that one robot may have", assumed},
      {"evidence.detectable_margin", e.detectable_margin, "",
       "log evidence beyond the least one that an error needs to be called detectable", assumed},
      {"evidence.noise.most_standstill", n.most_standstill, "",
       "an equation counts if dry friction of unknown direction is at most this share of its whole dry friction, "
       "squared",
       assumed},
      {"evidence.noise.fewest_rows", n.fewest_rows, "", "rows of a kind that its noise level needs", assumed},
      {"evidence.noise.longest_lag", n.longest_lag, "rows", "longest lag of the noise's autocorrelation", assumed},
      {"evidence.noise.least_autocorrelation", n.least_autocorrelation, "",
       "rows whose autocorrelation is smaller are independent", assumed},
      {"support.most_in_the_air", s.most_in_the_air, "weight",
       "a leg in the air shows what friction leaves of a force on its foot", robots},
      {"support.least_on_the_ground", s.least_on_the_ground, "weight", "a foot that stands carries at least this",
       robots},
      {"support.least_weight", s.least_weight, "weight", "two feet that stand carry together at least this", robots},
      {"support.most_weight", s.most_weight, "weight", "and at most this", robots},
      {"support.stepping_m_s", s.stepping_m_s, "m/s", "feet whose distance changes faster step", robots},
      {"support.flat_rad", s.flat_rad, "rad", "soles that are tilted further are not flat on the ground", robots},
      {"support.least_upright", s.least_upright, "",
       "cosine of the base's tilt: a robot that has fallen has its feet in the air too", "hidden robots 106 and 109"},
      {"ground.slipping_m_s", g.slipping_m_s, "m/s",
       "between the soles: from some 0.1 m/s a foot on a contact has its whole friction", physics},
      {"ground.sticking_m_s", g.sticking_m_s, "m/s", "below it soles creep under a force that a real ground would hold",
       physics},
      {"ground.quantile_of_slipping", g.quantile_of_slipping, "",
       "soles that begin or end to slip, or hop, show less than the ground's friction", robots},
      {"ground.quantile_of_sticking", g.quantile_of_sticking, "",
       "soles that stick show that the ground's friction is at least this", assumed},
      {"ground.least_load", g.least_load, "weight", "on each foot", robots},
      {"ground.most_weight", g.most_weight, "weight", "on both feet: more is a landing", robots},
      {"ground.fewest_samples", g.fewest_samples, "", "of slipping soles", robots},
      {"ground.systematic", g.systematic, "",
       "standard deviation from the legs' friction and gains within their tolerances", robots},
      {"block_s", o.block_s, "s", "stretch that a fold leaves out", assumed},
      {"low_pass_s", o.low_pass_s, "s",
       "deviation of the Gaussian low-pass: -3 dB at 5.3 Hz; the hanging excitation ends at 2.1 Hz", assumed},
      {"standing_low_pass_s", o.standing_low_pass_s, "s",
       "deviation of the Gaussian low-pass while standing, where a squat takes seconds: noise that is in an equation "
       "and in its coefficients alike looks like too little mass",
       robots},
      {"settle_samples", o.settle_samples, "", "samples to each side of a change of support that are left out", robots},
      {"direction_low_pass_s", o.direction_low_pass_s, "s",
       "deviation of the low-pass of the speed that gives a joint's direction: an encoder's noise turns it at once",
       assumed},
      {"turning_rad_s", o.turning_rad_s, "rad/s", "slower joints turn: MuJoCo's dry friction is not at its full value",
       physics},
      {"remains_of_friction", o.remains_of_friction, "",
       "share of a joint's dry friction that its equation may leave near standstill", robots},
      {"remains_rad_s2", o.remains_rad_s2, "rad/s^2",
       "times the moved inertia: the rest from the noise of accelerations, five times that of a gyro with 0.01 rad/s "
       "after the low-pass",
       robots},
  };
  add_sizes(c, all);
  return all;
}

}  // namespace pmg::robot_diagnosis

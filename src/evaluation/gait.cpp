#include "evaluation/gait.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "control/control_cycle.hpp"
#include "generator/joint_roles.hpp"

namespace pmg::evaluation {

namespace {

using nlohmann::ordered_json;

constexpr double kStandBeforeWalk_s = 1.5, kUntilSteady_s = 4.0;
constexpr double kLoadedFoot_N = 20.0;
constexpr double kShortestSwing_s = 0.1;  // a shorter one is a bouncing foot
constexpr const char* kSideNames[] = {"left", "right"};

sil::Scenario gait_scenario(const GaitTest& test) {
  sil::ScenarioStep stand{.start_s = 0.0,
                          .duration_s = kStandBeforeWalk_s,
                          .text = "stand",
                          .mode = control::Mode::kStand,
                          .command = {},
                          .hoist_without_policy = false};
  sil::ScenarioStep walk = stand;
  walk.start_s = kStandBeforeWalk_s;
  walk.duration_s = kUntilSteady_s + test.steady_s;
  walk.text = "walk";
  walk.mode = control::Mode::kWalk;
  walk.command[kVx] = test.speed_m_s;
  return {.name = "gait", .steps = {stand, walk}};
}

bool makes_two_steps(const FootRecording& recording) {
  return initial_contacts(recording.loaded, control::ControlCycle::kPeriod_s).size() >= 2;
}

FootGait foot_gait(const FootRecording& recording, const GaitNorms& norms) {
  const std::vector<std::size_t> contacts = initial_contacts(recording.loaded, control::ControlCycle::kPeriod_s);
  if (!makes_two_steps(recording)) throw std::runtime_error("the robot doesn't walk: a foot makes no two steps");
  FootGait gait;
  gait.cycles = static_cast<int>(contacts.size()) - 1;
  const auto begin = recording.loaded.begin() + static_cast<std::ptrdiff_t>(contacts.front());
  const auto end = recording.loaded.begin() + static_cast<std::ptrdiff_t>(contacts.back());
  gait.period_s = static_cast<double>(end - begin) * control::ControlCycle::kPeriod_s / gait.cycles;
  gait.duty_factor = static_cast<double>(std::count(begin, end, true)) / static_cast<double>(end - begin);
  gait.contact_late = mean_at(recording.since_planned_contact, contacts);
  for (std::size_t joint = 0; joint < kGaitJoints; ++joint) {
    gait.measured_deg[joint] = mean_cycle(recording.measured_deg[joint], contacts);
    gait.reference_deg[joint] = mean_cycle(recording.reference_deg[joint], contacts);
    gait.measured[joint] = agreement(gait.measured_deg[joint], norms.deg[joint]);
    gait.reference[joint] = agreement(gait.reference_deg[joint], norms.deg[joint]);
  }
  return gait;
}

ordered_json agreement_json(const CurveAgreement& a) {
  return {{"correlation", a.correlation}, {"rms_deg", a.rms_deg}, {"shape_rms_deg", a.shape_rms_deg}};
}

}  // namespace

std::array<double, kGaitJoints> flexions_deg(const JointVector& q, const std::array<int, generator::kLegJoints>& leg,
                                             double pelvis_pitch_rad) {
  return {(-q[leg[generator::kHipPitch]] - pelvis_pitch_rad) / kRadPerDegree, q[leg[generator::kKnee]] / kRadPerDegree,
          -q[leg[generator::kAnklePitch]] / kRadPerDegree};
}

std::vector<std::size_t> initial_contacts(const std::vector<bool>& loaded, double dt_s) {
  const auto shortest = static_cast<std::size_t>(std::lround(kShortestSwing_s / dt_s));
  std::vector<std::size_t> contacts;
  std::size_t in_air = 0;
  for (std::size_t tick = 0; tick < loaded.size(); ++tick) {
    if (loaded[tick] && in_air >= shortest) contacts.push_back(tick);
    in_air = loaded[tick] ? 0 : in_air + 1;
  }
  return contacts;
}

std::vector<double> mean_cycle(const std::vector<double>& values, const std::vector<std::size_t>& contacts) {
  std::vector<double> mean(kCyclePoints, 0.0);
  const double share = 1.0 / static_cast<double>(contacts.size() - 1);
  for (std::size_t cycle = 0; cycle + 1 < contacts.size(); ++cycle) {
    const auto ticks = static_cast<double>(contacts[cycle + 1] - contacts[cycle]);
    for (std::size_t k = 0; k < kCyclePoints; ++k) {
      const double at = static_cast<double>(contacts[cycle]) + ticks * static_cast<double>(k) / kCyclePoints;
      const auto below = static_cast<std::size_t>(at);
      mean[k] += share * std::lerp(values[below], values[below + 1], at - static_cast<double>(below));
    }
  }
  return mean;
}

double cycles_since_contact(double phase, double contact_center, double duty_factor) {
  const double since = phase - (contact_center - 0.5 * duty_factor);
  return since - std::floor(since + 0.5);
}

double mean_at(const std::vector<double>& values, const std::vector<std::size_t>& contacts) {
  double sum = 0.0;
  for (const std::size_t tick : contacts) sum += values[tick];
  return sum / static_cast<double>(contacts.size());
}

CurveAgreement agreement(const std::vector<double>& ours, const std::vector<double>& published) {
  const auto n = static_cast<Eigen::Index>(ours.size());
  const Eigen::Map<const Eigen::ArrayXd> a(ours.data(), n), b(published.data(), n);
  const Eigen::ArrayXd da = a - a.mean(), db = b - b.mean();
  return {.correlation = (da * db).sum() / std::sqrt(da.square().sum() * db.square().sum()),
          .rms_deg = std::sqrt((a - b).square().mean()),
          .shape_rms_deg = std::sqrt((da - db).square().mean())};
}

bool GaitTest::duty_reached(Foot foot) const {
  return std::abs(feet[foot].duty_factor - kPublishedDutyFactor) <= kAskedDutyDifference;
}

work::Worth worth_of(const GaitTest& test) {
  work::Worth worth;
  worth.add_if(
      !test.trial.complete, work::Grade::kInterrupted,
      fmt::format("{} and {} of the feet's cycles were walked", test.feet[kLeft].cycles, test.feet[kRight].cycles));
  worth.add_if(test.trial.complete && !test.trial.survived(), work::Grade::kMissed, "the robot fell or faulted");
  for (std::size_t joint = 0; joint < kGaitJoints; ++joint) {
    const CurveAgreement &left = test.feet[kLeft].measured[joint], &right = test.feet[kRight].measured[joint];
    const double least = std::min(left.correlation, right.correlation),
                 most_deg = std::max(left.rms_deg, right.rms_deg);
    worth.add_if(!(least >= kAskedCorrelation), work::Grade::kMissed,
                 fmt::format("the shape of {} correlates by {:.2f} with people's, asked {}", kGaitJointNames[joint],
                             least, kAskedCorrelation));
    worth.add_if(!(most_deg <= test.rms_limit_deg(joint)), work::Grade::kMissed,
                 fmt::format("{} is {:.0f} deg RMS from people's mean, asked {:.0f}", kGaitJointNames[joint], most_deg,
                             test.rms_limit_deg(joint)));
  }
  worth.add_if(!test.duty_reached(kLeft) || !test.duty_reached(kRight), work::Grade::kMissed,
               fmt::format("duty factor {:.2f} and {:.2f}, asked {} within {}", test.feet[kLeft].duty_factor,
                           test.feet[kRight].duty_factor, kPublishedDutyFactor, kAskedDutyDifference));
  return worth;
}

void run_gait(GaitTest& test, const Supervision& supervision) {
  const model::RobotModel robot = control::load_robot(test.evaluated.candidate.control);
  const generator::JointRoles roles = generator::find_joint_roles(robot);
  model::BaseAttitude pelvis_of_reference(robot);
  PerFoot<FootRecording> recordings;
  model::RobotState state;
  Eigen::Vector3d start_W = Eigen::Vector3d::Zero(), end_W = start_W;
  double duty_sum = 0.0;
  const TrialObserver observer = [&](const sil::RunProgress& now, sim::World& world) {
    if (now.time_s < kStandBeforeWalk_s + kUntilSteady_s) return true;
    const model::GroundTruth truth = world.truth();
    world.read(state);
    if (recordings[kLeft].loaded.empty()) start_W = truth.p_WB;
    end_W = truth.p_WB;
    const auto& planned = now.result.reference;
    const Command& u = now.result.optimised.command;
    const auto pelvis = pelvis_of_reference.compute(planned.q, planned.dq, u[kPitch], u[kRoll], 0.0, 0.0);
    const double planned_pitch_rad = sil::roll_pitch(Eigen::Quaterniond(pelvis.R_HB)).pitch_rad;
    duty_sum += planned.duty_factor[kLeft];
    for (const Foot foot : {kLeft, kRight}) {
      recordings[foot].loaded.push_back(truth.foot_force_N[foot] > kLoadedFoot_N);
      recordings[foot].since_planned_contact.push_back(
          cycles_since_contact(planned.phase, planned.contact_center[foot], planned.duty_factor[foot]));
      const auto measured = flexions_deg(state.q, roles.leg[foot], sil::roll_pitch(truth.q_WB).pitch_rad);
      const auto reference = flexions_deg(planned.q, roles.leg[foot], planned_pitch_rad);
      for (std::size_t joint = 0; joint < kGaitJoints; ++joint) {
        recordings[foot].measured_deg[joint].push_back(measured[joint]);
        recordings[foot].reference_deg[joint].push_back(reference[joint]);
      }
    }
    return now.result.mode != control::Mode::kFault;
  };
  test.trial = run_trial(test.evaluated.candidate, gait_scenario(test), test.evaluated.plants.of(robot, 1),
                         {.gantry = false, .progress = supervision.progress, .observer = observer});
  const auto ticks = static_cast<double>(recordings[kLeft].loaded.size());
  if (ticks > 1.0) {
    test.walked_m_s = (end_W - start_W).head<2>().norm() / ((ticks - 1.0) * control::ControlCycle::kPeriod_s);
    test.reference_duty_factor = duty_sum / ticks;
  }
  for (const Foot foot : {kLeft, kRight}) {
    if (!test.trial.complete && !makes_two_steps(recordings[foot])) throw work::Interrupted();
    test.feet[foot] = foot_gait(recordings[foot], test.norms);
  }
}

ordered_json to_json(const GaitTest& test) {
  ordered_json rms_limits;
  for (std::size_t joint = 0; joint < kGaitJoints; ++joint)
    rms_limits[kGaitJointNames[joint]] = test.rms_limit_deg(joint);
  ordered_json json = {
      {"kind", "gait"},
      {"complete", test.trial.complete},
      {"robot", test.robot},
      {"policy", test.evaluated.name},
      {"commanded_m_s", test.speed_m_s},
      {"walked_m_s", test.walked_m_s},
      {"fell", test.trial.fell},
      {"norms", test.norms.source},
      {"limits",
       {{"correlation", kAskedCorrelation},
        {"duty_factor", {kPublishedDutyFactor - kAskedDutyDifference, kPublishedDutyFactor + kAskedDutyDifference}},
        {"rms_deg", rms_limits},
        {"reached", worth_of(test).usable()}}},
      {"reference_duty_factor", test.reference_duty_factor},
      {"published_duty_factor", kPublishedDutyFactor}};
  for (const Foot foot : {kLeft, kRight}) {
    const FootGait& gait = test.feet[foot];
    ordered_json& entry = json["feet"][kSideNames[foot]];
    entry = {{"cycles", gait.cycles},
             {"period_s", gait.period_s},
             {"duty_factor", gait.duty_factor},
             {"contact_late_share", gait.contact_late}};
    for (std::size_t joint = 0; joint < kGaitJoints; ++joint) {
      entry["joints"].push_back({{"joint", kGaitJointNames[joint]},
                                 {"measured", agreement_json(gait.measured[joint])},
                                 {"reference", agreement_json(gait.reference[joint])},
                                 {"measured_deg", gait.measured_deg[joint]},
                                 {"reference_deg", gait.reference_deg[joint]}});
    }
  }
  for (std::size_t joint = 0; joint < kGaitJoints; ++joint)
    json["published_deg"][kGaitJointNames[joint]] = test.norms.deg[joint];
  return json;
}

std::vector<pages::Table> tables_of(const GaitTest& test) {
  pages::Table speed{.header = {"asked [m/s]", "walked [m/s]", "end"}, .rows = {}};
  speed.rows.push_back({fmt::format("{}", test.speed_m_s), fmt::format("{:.3f}", test.walked_m_s),
                        test.trial.fell ? "fell" : "did not fall"});
  pages::Table joints{.header = {"foot", "joint", "correlation", "RMS [deg]", "of the shape [deg]",
                                 "reference's correlation", "reference's RMS [deg]", ""},
                      .rows = {}};
  pages::Table feet{.header = {"foot", "cycles", "period [s]", "duty factor", "reference's", "published",
                               "lands after the reference [% of a cycle]", ""},
                    .rows = {}};
  for (const Foot foot : {kLeft, kRight}) {
    const FootGait& gait = test.feet[foot];
    for (std::size_t joint = 0; joint < kGaitJoints; ++joint) {
      const CurveAgreement &m = gait.measured[joint], &r = gait.reference[joint];
      const bool reached = m.correlation >= kAskedCorrelation && m.rms_deg <= test.rms_limit_deg(joint);
      joints.rows.push_back({kSideNames[foot], kGaitJointNames[joint], fmt::format("{:.3f}", m.correlation),
                             fmt::format("{:.1f}", m.rms_deg), fmt::format("{:.1f}", m.shape_rms_deg),
                             fmt::format("{:.3f}", r.correlation), fmt::format("{:.1f}", r.rms_deg),
                             reached ? "ok" : "MISSED"});
    }
    feet.rows.push_back({kSideNames[foot], std::to_string(gait.cycles), fmt::format("{:.3f}", gait.period_s),
                         fmt::format("{:.3f}", gait.duty_factor), fmt::format("{:.3f}", test.reference_duty_factor),
                         fmt::format("{:.2f}", kPublishedDutyFactor), fmt::format("{:.1f}", 100.0 * gait.contact_late),
                         test.duty_reached(foot) ? "ok" : "MISSED"});
  }
  return {speed, joints, feet};
}

pages::Page page_of(const GaitTest& test) {
  pages::Page page(
      fmt::format("Gait: {} on {}, asked to walk at {} m/s", test.evaluated.name, test.robot, test.speed_m_s));
  page.worth(worth_of(test));
  if (worth_of(test).usable())
    page.verdict(
        {}, fmt::format("Shapes, angles and duty factors are as people's (correlation at least {}, RMS within {:g} "
                        "standard deviations between persons, duty factor within {} of {})",
                        kAskedCorrelation, kAskedDeviations, kAskedDutyDifference, kPublishedDutyFactor));
  for (const pages::Table& table : tables_of(test)) page.table(table);
  std::vector<double> percent(kCyclePoints);
  for (std::size_t k = 0; k < kCyclePoints; ++k) percent[k] = static_cast<double>(k);
  page.heading("Joints over the gait cycle");
  page.columns([&] {
    for (std::size_t joint = 0; joint < kGaitJoints; ++joint) {
      for (const Foot foot : {kLeft, kRight}) {
        const FootGait& gait = test.feet[foot];
        page.chart(
            {.title = fmt::format("{} {} [deg]: RMS {:.1f} deg, {:.1f} without offset, correlation {:.3f}",
                                  kSideNames[foot], kGaitJointNames[joint], gait.measured[joint].rms_deg,
                                  gait.measured[joint].shape_rms_deg, gait.measured[joint].correlation),
             .x_name = "cycle",
             .x_unit = "%",
             .lines = {{.name = "measured", .x = percent, .y = gait.measured_deg[joint], .width_px = 2.2},
                       {.name = "reference",
                        .x = percent,
                        .y = gait.reference_deg[joint],
                        .colour = pages::colour::kVermillion,
                        .dashed = true},
                       {.name = "published", .x = percent, .y = test.norms.deg[joint], .colour = pages::colour::kGrey}},
             .marks = {{100.0 * gait.duty_factor, "foot off"}}});
      }
    }
  });
  page.heading("How it was measured");
  page.paragraph(
      fmt::format("{:.0f} s of steady walking at {:.3f} m/s, one robot as the model says. Cycles run from a foot's "
                  "initial contact to "
                  "its next; hip flexion is that of the thigh, pelvic tilt taken off the published curve. Published "
                  "joints: {}; foot off: "
                  "Schwartz et al. 2008, slow walking.",
                  test.steady_s, test.walked_m_s, test.norms.source));
  return page;
}

}  // namespace pmg::evaluation
